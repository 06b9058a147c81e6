#include "engine/scene/catalogue.hpp"

#include <fmt/format.h>

#include <utility>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

template <class E, std::size_t N>
std::vector<CatalogueEntry> words_of(const std::array<Word<E>, N>& words) {
  std::vector<CatalogueEntry> out;
  for (const Word<E>& word : words) out.push_back({word.name, "", word.says});
  return out;
}

/// Materials and shapes: a name, its keys, a line.
template <class Kind>
std::vector<CatalogueEntry> kinds_of(const std::vector<Kind>& kinds) {
  std::vector<CatalogueEntry> out;
  for (const Kind& kind : kinds) out.push_back({kind.name, kind.keys, kind.says});
  return out;
}

/// A law with its parameters.
std::vector<CatalogueEntry> laws() {
  std::vector<CatalogueEntry> out = words_of(kLaws);
  for (std::size_t k = 0; k < out.size(); ++k) {
    for (const LawParameter& parameter : law_parameters()) {
      if (!has_parameter(kLaws[k].value, parameter)) continue;
      if (!out[k].keys.empty()) out[k].keys += ", ";
      out[k].keys += parameter.name;
      if (!parameter.needed) out[k].keys += fmt::format(" = {}", LawSpec{}.*parameter.value);
    }
  }
  return out;
}

std::vector<CatalogueEntry> boundaries() {
  return {
      {"wall", "",
       "on a face (left, right, bottom, top, back, front): nothing moves through it, it slides freely"},
      {"symmetry", "", "another word for wall"},
      {"fixed", "", "a wall that also holds sideways"},
      {"free", "", "no condition (default)"},
      {"{wall: …}", "wall: sliding or held, position", "a wall at another place than the grid's face"},
      {"{piston: …}", "piston: speed or table, direction = inwards, held = false, position", "a moving wall"},
      {"NAME: {box: …}", "box: {from, to}, direction, speed: speed or table",
       "one velocity component prescribed at every node in the box"},
      {"NAME: {node: …}", "node: point, direction, speed: speed or table",
       "the same at the node nearest to a point"}};
}

std::vector<CatalogueEntry> seedings() {
  return {{"lattice", "", "on the grid's lattice, of a box on one of its own (default)"},
          {"rings", "", "about the centre of a disk or a ring, so that its outline is smooth"},
          {"{angle: …}", "",
           "on a lattice turned about z, along the edges of a block that lies across the grid"}};
}

std::vector<CatalogueEntry> output_keys() {
  const OutputSpec plain;
  return {
      {"frames", fmt::format("= {}", plain.frames), "particle files, evenly spaced in time; 0: none"},
      {"history", fmt::format("= {}", plain.history), "rows of history.csv"},
      {"overlap", fmt::format("= {}", plain.overlap),
       "2-D: history.csv and run.json say how much bodies enter each other"},
      {"grid", fmt::format("= {}", plain.grid),
       "with each frame after the first a file of the nodes (grid.pvd): masses, velocities, normals, "
       "separations"},
      {"checkpoint",
       fmt::format("none or {{every: TIME of wall = {} min, steps: N}}", plain.checkpoint.every / 60),
       "when the state is written for `mpmfast resume`, beside at a signal and at the end"},
      {"picture", "= " + plain.picture, "what the second picture shows (see pictures); none: no pictures"}};
}

}  // namespace

std::vector<std::string> catalogue_topics() {
  return {"spaces",    "materials", "bases",       "updates",    "strains", "deformation_terms",
          "positions", "normals",   "separations", "detections", "laws",    "areas",
          "fields",    "shapes",    "seedings",    "boundaries", "leaving", "output",
          "pictures"};
}

std::vector<CatalogueEntry> catalogue(const std::string& topic) {
  if (topic == "spaces") return words_of(kSpaces);
  if (topic == "materials") return kinds_of(material_kinds());
  if (topic == "bases") return words_of(kBases);
  if (topic == "updates") return words_of(kUpdates);
  if (topic == "strains") return words_of(kStrains);
  if (topic == "deformation_terms") return words_of(kDeformationTerms);
  if (topic == "positions") return words_of(kPositions);
  if (topic == "normals") return words_of(kNormals);
  if (topic == "separations") return words_of(kSeparations);
  if (topic == "detections") return words_of(kDetections);
  if (topic == "laws") return laws();
  if (topic == "areas") return words_of(kAreas);
  if (topic == "fields") return words_of(kManyFields);
  if (topic == "shapes") return kinds_of(shape_kinds());
  if (topic == "seedings") return seedings();
  if (topic == "boundaries") return boundaries();
  if (topic == "leaving") return words_of(kLeaving);
  if (topic == "output") return output_keys();
  std::vector<CatalogueEntry> out;
  if (topic != "pictures") return out;
  for (const char* picture : kPictures) out.push_back({picture, "", ""});
  return out;
}

}  // namespace mpmfast
