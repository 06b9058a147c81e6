/// Which facets of other bodies may touch which: lists that hold until a point has gone half of kSkin.

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/contact/penalty/penalty.hpp"
#include "engine/state/team.hpp"

namespace mpmfast {

/// The farthest that a point has gone, m: lists hold up to half of kSkin.
template <int Dim>
double Penalty<Dim>::moved_since_listed() const {
  double squared = 0;
  for (int p : near_points_)
    squared = std::max(squared, (at(p) - listed_at_[static_cast<std::size_t>(p)]).squaredNorm());
  return std::sqrt(squared);
}

/// No point of a facet is nearer to those listed with it, m.
template <int Dim>
double Penalty<Dim>::clearance(const Listing& listing) const {
  double least = kInfinity;
  for (int k = 0; k < kPoints; ++k) {
    const Vec<Dim> x = mean(listing.facet, k, now_);
    for (int j = listing.begin; j < listing.end; ++j) {
      const Ball& other = ball(listed(j));
      const Vec<Dim> from = x - other.middle;
      least = std::min(least, std::max(from.norm() - other.radius, std::abs(other.normal.dot(from))));
    }
  }
  return least;
}

/// What lies in tiles that share nodes with another field: the others touch nothing before the next sort.
/// What was near before stays so until something else comes near.
/// @return  has something come near?
template <int Dim>
bool Penalty<Dim>::find_near(const State<Dim>& state) {
  const auto& tiling = state.tiling;
  shared_.assign(tiling.node_tiles.size(), 0);
  for (const auto& stack : tiling.stacks)
    if (stack.end - stack.begin > 1)
      for (int t = stack.begin; t < stack.end; ++t) shared_[static_cast<std::size_t>(t)] = 1;
  near_now_.assign(surfaces_->points(), 0);
  for (const auto& tile : tiling.tiles) {
    bool meets = false;
    for (const int slot : tile.slot) meets |= shared_[static_cast<std::size_t>(slot / kTileNodes<Dim>)] != 0;
    if (!meets) continue;
    for (int r = tile.run_begin; r < tile.run_end; ++r) {
      const auto& run = tiling.runs[static_cast<std::size_t>(r)];
      if (!run.on_surface) continue;
      for (std::uint32_t p = run.begin; p < run.end; ++p)
        near_now_[static_cast<std::size_t>(surfaces_->number(run.body, state.particles.id()[p]))] = 1;
    }
  }
  bool more = is_near_.empty();
  for (std::size_t p = 0; p < is_near_.size(); ++p) more |= near_now_[p] > is_near_[p];
  if (!more) return false;
  is_near_ = near_now_;
  for (int f : near_facets_) ball_[static_cast<std::size_t>(f)].body = -1;
  near_facets_.clear();
  for (std::size_t f = 0; f < surfaces_->facets.size(); ++f) {
    const auto& corner = surfaces_->facets[f].point;
    if (std::none_of(corner.begin(), corner.end(),
                     [&](int p) { return is_near_[static_cast<std::size_t>(p)]; }))
      continue;
    near_facets_.push_back(static_cast<int>(f));
    for (int p : corner) near_now_[static_cast<std::size_t>(p)] = 1;
  }
  near_points_.clear();  // all corners of these facets
  for (std::size_t p = 0; p < near_now_.size(); ++p)
    if (near_now_[p]) near_points_.push_back(static_cast<int>(p));
  return true;
}

template <int Dim>
NodeIndex<Dim> Penalty<Dim>::cell_of(const Vec<Dim>& x) const {
  NodeIndex<Dim> cell;
  for (int d = 0; d < Dim; ++d) cell[d] = node_at(std::floor(x[d] / side_));
  return cell;
}

template <int Dim>
std::size_t Penalty<Dim>::bucket_of(const NodeIndex<Dim>& cell) const {
  constexpr std::uint32_t kPrimes[3] = {73856093u, 19349663u, 83492791u};
  std::uint32_t hash{};
  for (int d = 0; d < Dim; ++d) hash ^= static_cast<std::uint32_t>(cell[d]) * kPrimes[d];
  hash ^= hash >> 15;
  return hash & (static_cast<std::uint32_t>(bucket_begin_.size()) - 2);
}

template <int Dim>
void Penalty<Dim>::find_balls(int threads) {
  const auto n = static_cast<std::int64_t>(near_facets_.size());
  for_each_of(n, threads, 256, [&](std::int64_t k) {
    const int f = near_facets_[static_cast<std::size_t>(k)];
    Ball ball{Vec<Dim>::Zero(), facet_normal(f), 0, facet(f).body};
    for (int p : facet(f).point) ball.middle += at(p);
    ball.middle /= Dim;
    for (int p : facet(f).point) ball.radius = std::max(ball.radius, (at(p) - ball.middle).squaredNorm());
    ball.radius = std::sqrt(ball.radius);
    ball_[static_cast<std::size_t>(f)] = ball;
  });
}

/// Facets by the cell of their middle, of such a side that what comes within a cell of the grid of any point
/// of a facet, as long as the lists hold, lies in the cells around the facet's own.
template <int Dim>
void Penalty<Dim>::fill_bins() {
  const auto n = near_facets_.size();
  double widest = 0;
  for (int f : near_facets_) widest = std::max(widest, ball_[static_cast<std::size_t>(f)].radius);
  side_ = (1 + kSkin) * cell_ + 2 * widest;
  std::size_t buckets = 16;
  while (buckets < 2 * n) buckets *= 2;
  bucket_begin_.assign(buckets + 1, 0);
  binned_.resize(n);
  const auto cell_of_facet = [&](std::size_t k) {
    return cell_of(ball_[static_cast<std::size_t>(near_facets_[k])].middle);
  };
  for (std::size_t k = 0; k < n; ++k) ++bucket_begin_[bucket_of(cell_of_facet(k))];
  for (std::size_t b = 0; b < buckets; ++b) bucket_begin_[b + 1] += bucket_begin_[b];
  // From behind, so that each bucket has its facets in rising order.
  for (std::size_t k = n; k-- > 0;) {
    const NodeIndex<Dim> cell = cell_of_facet(k);
    const int f = near_facets_[k];
    binned_[static_cast<std::size_t>(--bucket_begin_[bucket_of(cell)])] = {
        cell, f, facet(f).body, ball_[static_cast<std::size_t>(f)]};
  }
}

/// The facets in the cells around one that what is of the body may touch, by their numbers.
template <int Dim>
void Penalty<Dim>::list_bins(const NodeIndex<Dim>& cell, int body, std::vector<const Binned*>& out) const {
  const int field = field_of(body);
  const bool rigid = body_rigid_[static_cast<std::size_t>(body)];
  out.clear();
  for (int k = 0; k < power(3, Dim); ++k) {
    NodeIndex<Dim> there = cell;
    int digits = k;
    for (int d = 0; d < Dim; ++d, digits /= 3) there[d] += digits % 3 - 1;
    const std::size_t bucket = bucket_of(there);
    for (int b = bucket_begin_[bucket]; b < bucket_begin_[bucket + 1]; ++b) {
      const Binned& binned = binned_[static_cast<std::size_t>(b)];
      if (field_of(binned.body) == field || binned.cell != there) continue;
      if (rigid && body_rigid_[static_cast<std::size_t>(binned.body)]) continue;
      out.push_back(&binned);
    }
  }
  std::sort(out.begin(), out.end(), [](const Binned* a, const Binned* b) { return a->facet < b->facet; });
}

/// The facets of other bodies that may touch a facet, by their numbers.
template <int Dim>
void Penalty<Dim>::list_around(int own, Room& room) const {
  const Ball& ball = ball_[static_cast<std::size_t>(own)];
  const NodeIndex<Dim> cell = cell_of(ball.middle);
  if (room.body != ball.body || room.cell != cell) {  // most follow one of the same cell
    room.body = ball.body;
    room.cell = cell;
    list_bins(cell, ball.body, room.binned);
  }
  const auto begin = static_cast<std::ptrdiff_t>(room.listed.size());
  for (const Binned* binned : room.binned) {
    const double most = (1 + kSkin) * cell_ + ball.radius + binned->ball.radius;
    if ((ball.middle - binned->ball.middle).squaredNorm() <= most * most)
      room.listed.push_back(binned->facet);
  }
  leave_far_ones(ball, begin, room.listed);
}

/// Of each piece, what cannot have the nearest foot of a point of the facet, as long as the lists hold, goes.
template <int Dim>
void Penalty<Dim>::leave_far_ones(const Ball& ball, std::ptrdiff_t begin, std::vector<int>& out) const {
  struct Piece {
    int number;
    double nearest;  ///< m, of the middles
  };
  std::array<Piece, 4 * kNear> pieces;
  std::size_t count = 0;
  const auto place_of = [&](int f) {
    std::size_t k = 0;
    while (k < count && pieces[k].number != facet(f).piece) ++k;
    return k;
  };
  const auto distance = [&](int f) {
    return (ball.middle - ball_[static_cast<std::size_t>(f)].middle).norm();
  };
  for (auto f = out.begin() + begin; f != out.end(); ++f) {
    const std::size_t k = place_of(*f);
    if (k == pieces.size()) return;  // more than are known: all stay
    if (k == count) pieces[count++] = {facet(*f).piece, distance(*f)};
    pieces[k].nearest = std::min(pieces[k].nearest, distance(*f));
  }
  const double slack = 2 * (ball.radius + kSkin * cell_);
  out.erase(std::remove_if(out.begin() + begin, out.end(),
                           [&](int f) {
                             return distance(f) - ball_[static_cast<std::size_t>(f)].radius >
                                    pieces[place_of(f)].nearest + slack;
                           }),
            out.end());
}

/// Which facets may touch which until a point has gone half of kSkin.
template <int Dim>
void Penalty<Dim>::list_all(int threads) {
  fill_bins();
  const auto n = static_cast<std::int64_t>(near_facets_.size());
  for (Room& room : rooms_) {
    room.listing.clear();
    room.listed.clear();
    room.body = -1;
  }
  for_each_of(n, threads, 256, [&](std::int64_t k) {
    Room& room = rooms_[static_cast<std::size_t>(own_number())];
    const int begin = static_cast<int>(room.listed.size());
    list_around(near_facets_[static_cast<std::size_t>(k)], room);
    const int end = static_cast<int>(room.listed.size());
    if (end > begin) room.listing.push_back({near_facets_[static_cast<std::size_t>(k)], begin, end, 0});
  });
  listing_.clear();
  listed_.clear();
  for (const Room& room : rooms_) {
    const int before = static_cast<int>(listed_.size());
    for (const Listing& one : room.listing)
      listing_.push_back({one.facet, before + one.begin, before + one.end, 0});
    listed_.insert(listed_.end(), room.listed.begin(), room.listed.end());
  }
  // Who lists is listed too.
  listed_wedges_.clear();
  for (const Listing& one : listing_)
    for (int w : facet(one.facet).wedge) listed_wedges_.push_back(w);
  std::sort(listed_wedges_.begin(), listed_wedges_.end());
  listed_wedges_.erase(std::unique(listed_wedges_.begin(), listed_wedges_.end()), listed_wedges_.end());
  listed_at_ = now_;
}

// Here: the members that this file defines.
template double Penalty<2>::moved_since_listed() const;
template double Penalty<2>::clearance(const Listing&) const;
template bool Penalty<2>::find_near(const State<2>&);
template NodeIndex<2> Penalty<2>::cell_of(const Vec<2>&) const;
template std::size_t Penalty<2>::bucket_of(const NodeIndex<2>&) const;
template void Penalty<2>::fill_bins();
template void Penalty<2>::list_bins(const NodeIndex<2>&, int, std::vector<const Binned*>&) const;
template void Penalty<2>::list_around(int, Room&) const;
template void Penalty<2>::leave_far_ones(const Ball&, std::ptrdiff_t, std::vector<int>&) const;
template void Penalty<2>::list_all(int);
template void Penalty<2>::find_balls(int);
template double Penalty<3>::moved_since_listed() const;
template double Penalty<3>::clearance(const Listing&) const;
template bool Penalty<3>::find_near(const State<3>&);
template NodeIndex<3> Penalty<3>::cell_of(const Vec<3>&) const;
template std::size_t Penalty<3>::bucket_of(const NodeIndex<3>&) const;
template void Penalty<3>::fill_bins();
template void Penalty<3>::list_bins(const NodeIndex<3>&, int, std::vector<const Binned*>&) const;
template void Penalty<3>::list_around(int, Room&) const;
template void Penalty<3>::leave_far_ones(const Ball&, std::ptrdiff_t, std::vector<int>&) const;
template void Penalty<3>::list_all(int);
template void Penalty<3>::find_balls(int);

}  // namespace mpmfast
