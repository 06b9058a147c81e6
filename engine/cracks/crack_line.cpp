#include "engine/cracks/crack_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "engine/constants.hpp"
#include "engine/cracks/element.hpp"
#include "engine/errors.hpp"
#include "engine/scene/crack_tips.hpp"

namespace mpmfast {

namespace {

/// A corner of a crack: z is zero in three dimensions.
template <int Dim>
Vec<Dim> corner_of(const CrackSpec& crack, std::size_t k) {
  Vec<Dim> x = Vec<Dim>::Zero();
  for (int d = 0; d < 2; ++d) x[d] = element(crack.points[k], d);
  return x;
}

template <int Dim>
std::vector<Vec<Dim>> divided(const CrackSpec& crack) {
  std::vector<Vec<Dim>> points{corner_of<Dim>(crack, 0)};
  for (std::size_t k = 1; k < crack.points.size(); ++k) {
    const Vec<Dim> from = corner_of<Dim>(crack, k - 1), along = corner_of<Dim>(crack, k) - from;
    const int pieces = std::max(
        1, static_cast<int>(std::ceil(along.norm() / crack.spacing - crack_constants::kPieceRoundOff)));
    for (int piece = 1; piece < pieces; ++piece)
      points.push_back(from + along * (static_cast<double>(piece) / pieces));
    points.push_back(corner_of<Dim>(crack, k));
  }
  return points;
}

template <int Dim>
void visit_points(Archive& archive, const std::string& name, std::vector<Vec<Dim>>& points) {
  std::vector<double> coordinates;
  for (const Vec<Dim>& x : points) coordinates.insert(coordinates.end(), x.data(), x.data() + Dim);
  archive.list(name, coordinates);
  require_checkpoint(archive, coordinates.size() % Dim == 0, name);
  points.resize(coordinates.size() / Dim);
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::copy_n(coordinates.data() + Dim * p, Dim, points[p].data());
    require_checkpoint(archive, points[p].allFinite(), name);
  }
}

void visit_end(Archive& archive, const std::string& name, CrackEnd& end) {
  const bool may_grow = end.grows;  // by the scene, while a file is read
  archive.flag(name + "/grows", end.grows);
  require_checkpoint(archive, !end.grows || may_grow, name + "/grows");
  archive.number(name + "/due", end.due);
  archive.number(name + "/straight", end.straight);
  archive.number(name + "/grown", end.grown);
  archive.flag(name + "/fresh", end.fresh);
  require_checkpoint(archive, !std::isnan(end.due) && !std::isnan(end.straight) && std::isfinite(end.grown),
                     name);
}

}  // namespace

void require_checkpoint(const Archive& archive, bool fits, const std::string& name) {
  if (archive.reading() && !fits)
    throw FileError(fmt::format("the checkpoint is none of its scene: {} does not fit it", name));
}

template <int Dim>
std::vector<CrackLine<Dim>> make_crack_lines(const Scene& scene, const Plan& plan) {
  std::vector<CrackLine<Dim>> lines;
  for (const CrackSpec& crack : scene.cracks) {
    CrackLine<Dim> line;
    line.field = element(plan.body_field, crack.body);
    line.node_mass =
        density_of(element(scene.materials, element(scene.bodies, crack.body).material)) * cell_volume(scene);
    line.points = divided<Dim>(crack);
    line.sides = {line.points, line.points};
    lines.push_back(line);
  }
  for (const CrackTip& tip : crack_tips(scene))
    element(lines, tip.crack).ends[tip.end].grows = element(scene.cracks, tip.crack).growth.active;
  return lines;
}

template <int Dim>
void visit_crack_lines(Archive& archive, std::vector<CrackLine<Dim>>& lines) {
  std::uint64_t count = lines.size();
  archive.number("cracks/count", count);
  require_checkpoint(archive, count == lines.size(), "cracks/count");
  for (std::size_t k = 0; k < lines.size(); ++k) {
    CrackLine<Dim>& line = lines[k];
    const std::string name = fmt::format("cracks/{}", k);
    int field = line.field;
    archive.number(name + "/field", field);
    require_checkpoint(archive, field == line.field, name + "/field");
    visit_points<Dim>(archive, name + "/points", line.points);
    visit_points<Dim>(archive, name + "/left", line.sides[0]);
    visit_points<Dim>(archive, name + "/right", line.sides[1]);
    const std::size_t points = line.points.size();
    require_checkpoint(archive, points >= 2, name + "/points");
    for (const auto& side : line.sides) require_checkpoint(archive, side.size() == points, name + "/points");
    for (const bool end : {false, true}) visit_end(archive, name + (end ? "/end" : "/start"), line.ends[end]);
  }
}

template std::vector<CrackLine<2>> make_crack_lines(const Scene&, const Plan&);
template std::vector<CrackLine<3>> make_crack_lines(const Scene&, const Plan&);
template void visit_crack_lines(Archive&, std::vector<CrackLine<2>>&);
template void visit_crack_lines(Archive&, std::vector<CrackLine<3>>&);

}  // namespace mpmfast
