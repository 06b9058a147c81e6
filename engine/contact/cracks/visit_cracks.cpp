/// What lasts of cracks from one step to the next, for an archive. A file may have been made by anyone: as
/// many cracks as the scene has, points that are numbers, and nodes that are there.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/contact/cracks/cracks.hpp"
#include "engine/errors.hpp"
#include "engine/state/archive.hpp"

namespace mpmfast {
namespace {

/// Of what is read alone: a run that fails may still be written.
void require(const Archive& archive, bool holds, const std::string& name) {
  if (archive.reading() && !holds)
    throw FileError(fmt::format("the checkpoint is none of its scene: {} does not fit it", name));
}

/// @param what  "cracks/0/points"
template <int Dim>
void visit_points(Archive& archive, const std::string& what, std::vector<Vec<Dim>>& points) {
  std::vector<double> places;
  for (const Vec<Dim>& x : points) places.insert(places.end(), x.data(), x.data() + Dim);
  archive.list(what, places);
  require(archive, places.size() % Dim == 0, what);
  points.resize(places.size() / Dim);
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::copy_n(places.data() + Dim * p, Dim, points[p].data());
    require(archive, points[p].allFinite(), what);
  }
}

void visit_end(Archive& archive, const std::string& of, CrackEnd& end) {
  const bool may_grow = end.grows;  // of the scene, where a file is read
  archive.flag(of + "/grows", end.grows);
  require(archive, !end.grows || may_grow, of + "/grows");
  archive.number(of + "/due", end.due);
  archive.number(of + "/straight", end.straight);
  archive.number(of + "/grown", end.grown);
  archive.flag(of + "/fresh", end.fresh);
  require(archive, !std::isnan(end.due) && !std::isnan(end.straight) && std::isfinite(end.grown), of);
}

}  // namespace

template <int Dim>
void Cracks<Dim>::visit(Archive& archive) {
  std::uint64_t count = lines_.size();
  archive.number("cracks/count", count);
  require(archive, count == lines_.size(), "cracks/count");
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    CrackLine<Dim>& line = lines_[k];
    const std::string name = fmt::format("cracks/{}", k);
    int field = line.field;
    archive.number(name + "/field", field);
    require(archive, field == line.field, name + "/field");
    visit_points<Dim>(archive, name + "/points", line.points);
    visit_points<Dim>(archive, name + "/left", line.sides[0]);
    visit_points<Dim>(archive, name + "/right", line.sides[1]);
    const std::size_t points = line.points.size();
    require(archive, points >= 2, name + "/points");
    for (const auto& side : line.sides) require(archive, side.size() == points, name + "/points");
    for (const bool end : {false, true}) visit_end(archive, name + (end ? "/end" : "/start"), line.ends[end]);
  }
  archive.number("cracks/drifted", drifted_);
  archive.number("cracks/moved", moved_);
  require(archive, drifted_ >= 0 && std::isfinite(moved_), "cracks/drifted");
  visit_nodes(archive);
}

/// What was seen last.
template <int Dim>
void Cracks<Dim>::visit_nodes(Archive& archive) {
  constexpr std::size_t kMost = CrackedNode<Dim>::kMost;
  archive.list("cracks/blocks", block_keys_);
  blocks_.resize(block_keys_.size());
  std::vector<int> places, told;
  std::vector<double> normals;
  for (const auto& block : blocks_) places.insert(places.end(), block.begin(), block.end());
  for (const CrackedNode<Dim>& node : nodes_)
    for (std::size_t k = 0; k < kMost; ++k) {
      told.insert(told.end(), {node.crack[k], node.ways[k]});
      normals.insert(normals.end(), node.normal[k].data(), node.normal[k].data() + Dim);
    }
  archive.column("cracks/places", places.data(), places.size());
  archive.list("cracks/told", told);
  require(archive, told.size() % (2 * kMost) == 0, "cracks/told");
  normals.resize(told.size() / 2 * Dim);
  archive.column("cracks/normals", normals.data(), normals.size());
  nodes_.resize(told.size() / (2 * kMost));
  const auto nodes = static_cast<int>(nodes_.size()), cracks = static_cast<int>(lines_.size());
  for (const int place : places) require(archive, place >= -1 && place < nodes, "cracks/places");
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    std::copy_n(places.data() + b * kTileNodes<Dim>, kTileNodes<Dim>, blocks_[b].begin());
  for (std::size_t n = 0, at = 0; n < nodes_.size(); ++n)
    for (std::size_t k = 0; k < kMost; ++k, ++at) {
      nodes_[n].crack[k] = told[2 * at];
      nodes_[n].ways[k] = told[2 * at + 1];
      std::copy_n(normals.data() + Dim * at, Dim, nodes_[n].normal[k].data());
      require(archive, told[2 * at] >= -1 && told[2 * at] < cracks && nodes_[n].normal[k].allFinite(),
              "cracks/told");
    }
}

// Here: the members that this file defines.
template void Cracks<2>::visit(Archive&);
template void Cracks<3>::visit(Archive&);
template void Cracks<2>::visit_nodes(Archive&);
template void Cracks<3>::visit_nodes(Archive&);

}  // namespace mpmfast
