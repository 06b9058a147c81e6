#include "engine/scene/catalogue.hpp"

#include "engine/scene/keys/basis_names.hpp"
#include "engine/scene/schema/known_keys.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

template <class E, std::size_t N>
std::vector<CatalogueEntry> keywords_of(const std::array<Keyword<E>, N>& words) {
  std::vector<CatalogueEntry> out;
  for (const Keyword<E>& word : words) out.push_back({word.name, "", word.description});
  return out;
}

std::string sentence_on(const std::string& pattern) {
  std::string description = known_at(pattern).description;
  if (!description.empty()) description.pop_back();  // the full stop
  return description;
}

/// Materials and shapes: a name, its keys, a line. The map of the keys stands at before + name + after.
template <class Kind>
std::vector<CatalogueEntry> kinds_of(const std::vector<Kind>& kinds, const std::string& before,
                                     const std::string& after = "") {
  std::vector<CatalogueEntry> out;
  for (const Kind& kind : kinds)
    out.push_back({kind.name, keys_text(before + kind.name + after), kind.description});
  return out;
}

/// A law with its parameters.
std::vector<CatalogueEntry> laws() {
  std::vector<CatalogueEntry> out;
  for (const ContactLawKind& law : contact_laws())
    out.push_back({law.name, law_keys_text(law), law.description});
  return out;
}

std::vector<CatalogueEntry> boundaries() {
  std::vector<CatalogueEntry> out = keywords_of(kFaceKinds);
  out.push_back({"{…}", keys_text("boundaries.FACE"), sentence_on("boundaries.FACE")});
  out.push_back({"NAME: {…}", keys_text("boundaries.NAME"), sentence_on("boundaries.NAME")});
  return out;
}

std::vector<CatalogueEntry> seedings() {
  std::vector<CatalogueEntry> out = keywords_of(kSeedings);
  out.push_back({"{angle: …}", "", sentence_on("bodies[].seeding.angle")});
  return out;
}

std::vector<CatalogueEntry> pictures() {
  std::vector<CatalogueEntry> out;
  for (const char* picture : kPictures) out.push_back({picture, "", ""});
  return out;
}

std::vector<CatalogueEntry> keys_of(const std::string& map) {
  std::vector<CatalogueEntry> out;
  for (const KnownKey& key : all_keys(map)) {
    const std::string standard = default_text(key.pattern), inner = keys_text(key.pattern);
    const std::string text = inner.empty() ? "" : "{" + inner + "}";
    out.push_back({key.name, standard.empty() ? text : text + "= " + standard, sentence_on(key.pattern)});
  }
  return out;
}

struct Topic {
  const char* name;
  std::vector<CatalogueEntry> (*entries)();
};
constexpr Topic kTopics[] = {
    {"spaces", [] { return keywords_of(kSpaces); }},
    {"materials", [] { return kinds_of(material_kinds(), "materials.NAME<model=", ">"); }},
    {"bases", [] { return keywords_of(kBases); }},
    {"updates", [] { return keywords_of(kUpdates); }},
    {"strains", [] { return keywords_of(kStrains); }},
    {"deformation_terms", [] { return keywords_of(kDeformationTerms); }},
    {"positions", [] { return keywords_of(kPositions); }},
    {"published", [] { return keywords_of(kPublishedContacts); }},
    {"normals", [] { return keywords_of(kNormals); }},
    {"separations", [] { return keywords_of(kSeparations); }},
    {"detections", [] { return keywords_of(kDetections); }},
    {"laws", laws},
    {"areas", [] { return keywords_of(kAreas); }},
    {"fields", [] { return keywords_of(kManyFields); }},
    {"jumps", [] { return keywords_of(kJumps); }},
    {"growth", [] { return keywords_of(kGrowthRules); }},
    {"shapes", [] { return kinds_of(shape_kinds(), "bodies[]."); }},
    {"seedings", seedings},
    {"boundaries", boundaries},
    {"leaving", [] { return keywords_of(kOutflowKinds); }},
    {"output", [] { return keys_of("output"); }},
    {"pictures", pictures},
};

}  // namespace

std::vector<std::string> catalogue_topics() { return names_of(kTopics); }

std::vector<CatalogueEntry> catalogue(const std::string& name) {
  for (const Topic& topic : kTopics)
    if (topic.name == name) return topic.entries();
  return {};
}

}  // namespace mpmfast
