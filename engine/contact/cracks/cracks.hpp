#pragma once

/// @file Cracks: surfaces inside of bodies, as lines of points that move with them. On the nodes near, the
/// particles of one body that lie on different sides of a crack have velocity fields of their own (NN §1.1).

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/geometry/crossing.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// An end of a crack: where it starts, or ends.
struct CrackEnd {
  bool grows = false;          ///< it lies in its body, and what drives it is asked
  double due{};                ///< when that is asked next, s
  double straight = HUGE_VAL;  ///< so far back it has not turned, m
  double grown = 0;            ///< m
  bool fresh = false;          ///< in the last step
};

/// A crack: its points, from one end to the other.
template <int Dim>
struct CrackLine {
  int field{};                   ///< of the body that it is in
  double node_mass{};            ///< of a node inside of it, at the start, kg
  std::vector<Vec<Dim>> points;  ///< m, between its sides
  /// Of those, where the material is that was there: on the left, on the right; m.
  std::array<std::vector<Vec<Dim>>, 2> sides;
  std::array<CrackEnd, 2> ends;  ///< where the points start, where they end

  double length() const {
    double sum = 0;
    for (std::size_t k = 1; k < points.size(); ++k) sum += (points[k] - points[k - 1]).norm();
    return sum;
  }
};

/// What the particles around a node see of cracks there.
template <int Dim>
struct CrackedNode {
  static constexpr int kMost = 2;  ///< cracks that a node tells apart
  std::array<int, kMost> crack{-1, -1};
  std::array<int, kMost> ways{0, 0};  ///< from particles to the node that come out on the left, less others
  /// Sums of the unit normals of what they cross, to the left.
  std::array<Vec<Dim>, kMost> normal{Vec<Dim>::Zero(), Vec<Dim>::Zero()};

  bool is_left(int k) const { return ways[static_cast<std::size_t>(k)] >= 0; }
};

/// The nodes on which particles have weight: from the first on, so many along each axis.
template <int Dim>
struct Supports {
  /// (particle, way) → the first, if it were farther by the way along each axis, m
  std::function<NodeIndex<Dim>(std::size_t, double)> first;
  int nodes{};
};

/// One for each node of a window.
template <int Dim>
using WindowBits = std::bitset<kWindowNodes<Dim>>;

struct TipLoad;

/// What particles see of cracks, beside what their tiles tell: the same; other sides, so that they must be
/// grouped anew; nodes outside of their windows, so that they must be sorted first.
enum class Seen { same, parted, outside };

struct CrackCounters {
  std::uint64_t groupings = 0;  ///< of the particles by their sides, after sorts and between them
  std::uint64_t third = 0;      ///< times that a particle saw a node behind a third crack
};

/// Sides are those of the material, not of the node (NN §1.1 calls what no crack hides from a node field
/// [0]): 0 is the left of the first crack of a node and the left of the second, 1 the right of the first, 2
/// of the second, 3 of both; and 0 everywhere else. A node that a crack passes by keeps its fields.
template <int Dim>
class Cracks {
 public:
  Cracks(const Scene& scene, const Plan& plan);

  bool active() const { return !lines_.empty(); }
  const std::vector<CrackLine<Dim>>& lines() const { return lines_; }
  const CrackCounters& counters() const { return counters_; }

  /// Is what was seen last out of date? Particles do not change sides, and a look counts the nodes that they
  /// come to soon: only at ends of cracks, in a line's normals and where it bends is it old by what has
  /// moved. Sooner at first: an end that lay on a node at the start is beside it once anything has moved.
  bool look_due(double cell) const {
    return drifted_ >= std::min(kDrift * cell, std::max(1e-5 * cell, 0.5 * moved_));
  }
  /// Everything has moved by so much at most, m.
  void drift(double way) { drifted_ += way, moved_ += way; }

  /// Finds what sides the particles see.
  Seen look(State<Dim>& state, const Supports<Dim>& supports);

  /// Groups the particles that see the same sides, and numbers the slots anew.
  void group(State<Dim>& state);

  /// Marks the tiles that reach nodes which cracks part, or soon will (ParticleTile::cracked), once tiles are
  /// others: they alone bring what tells the sides apart.
  void mark(State<Dim>& state, const Supports<Dim>& supports) const;

  /// Which crack parts two fields of a node, and its unit normal from the first to the second.
  struct Parting {
    int crack = -1;
    Vec<Dim> normal = Vec<Dim>::Zero();
    bool beyond = false;  ///< are both on the right of the node's other crack?
  };
  /// Are both fields sides of one body?
  bool same_body(const State<Dim>& state, int a, int b) const {
    return active() &&
           state.field_base[static_cast<std::size_t>(a)] == state.field_base[static_cast<std::size_t>(b)];
  }
  /// Across two cracks fields meet in a point only, and there is none; but where they are alone on the node,
  /// so that the cracks lie on each other, it is the first. For the fields of same_body, a < b.
  Parting parting(const State<Dim>& state, const NodeIndex<Dim>& node, int a, int b, bool alone) const;

  /// Moves the points with the bodies: each side with the velocities of its own, that nodes move particles
  /// with, and what lies between with the mean of both (NN §1.1).
  void move(const State<Dim>& state, double dt);

  /// Is any end to be asked whether it grows?
  bool growth_due(double time) const;
  /// Asks all that are due what drives them, and lets them grow. The stresses are those of the moment.
  /// @param load_of  (crack, end) → TipLoad
  void grow(const State<Dim>& state, const std::function<TipLoad(int, bool)>& load_of);

  bool grows(int crack) const { return scene_->cracks[static_cast<std::size_t>(crack)].growth.active; }
  /// Was what is now a side of it at this node whole before the crack grew in the last step?
  bool is_fresh(const State<Dim>& state, int crack, const NodeIndex<Dim>& node) const;
  /// What of lines is next to a place, if it is nearer than that: those of other cracks of the same body, and
  /// of its own what lies farther back.
  std::optional<Vec<Dim>> meets(int crack, bool end, const Vec<Dim>& x, double nearer) const;

  void visit(Archive& archive);

 private:
  void grow(const State<Dim>& state, int crack, bool end, const TipLoad& load);
  struct Segment {
    int crack;
    Vec<Dim> from, to, low, high, normal;  ///< unit, to the left
  };
  /// The particle's way to a node that crosses a crack.
  struct Crossed {
    std::uint32_t particle;
    NodeIndex<Dim> node;
    int crack, way;  ///< +1: to its left
    Vec<Dim> normal;
  };
  static constexpr double kDrift = 0.25;  ///< cells between looks
  static constexpr double kAhead = 0.32;  ///< cells that a look leads: domains may grow beside what they move

  /// The nodes on which a particle has weight until the next look: from the first on.
  struct Reach {
    NodeIndex<Dim> first, nodes;
  };
  static Reach reach_ahead(const Supports<Dim>& supports, std::size_t particle, double cell) {
    const NodeIndex<Dim> first = supports.first(particle, -kAhead * cell);
    return {first,
            supports.first(particle, kAhead * cell) - first + NodeIndex<Dim>::Constant(supports.nodes)};
  }
  /// What a particle sees of the nodes under its tile's window.
  struct Sides {
    std::uint32_t particle;
    WindowBits<Dim> reach;                 ///< where it has weight, or soon
    std::array<WindowBits<Dim>, 2> right;  ///< of these, right of the node's first and second crack
  };
  /// Boxes in the plane, many of which are asked at once whether they overlap another.
  class Boxes {
   public:
    void set(const std::vector<const Segment*>& segments);
    /// The numbers of those that do, rising.
    void list_overlapping(const Point2& low, const Point2& high, std::vector<int>& out) const;

   private:
    std::array<std::vector<double>, 2> low_, high_;  ///< a multiple of kLanes
    Point2 all_low_{}, all_high_{};
  };
  /// What one thread works in.
  struct Room {
    std::vector<const Segment*> near;
    Boxes boxes;  ///< around these
    std::vector<int> reached;
    Ways ways;
  };
  using WindowNodes = std::array<const CrackedNode<Dim>*, kWindowNodes<Dim>>;

  static std::uint64_t key_of(int field, const NodeIndex<Dim>& place);
  static int place_in_block(const NodeIndex<Dim>& node, NodeIndex<Dim>& block);
  const CrackedNode<Dim>* find(int field, const NodeIndex<Dim>& node) const;
  const std::array<int, kTileNodes<Dim>>* find_block(int field, const NodeIndex<Dim>& block) const;
  bool find_under(const ParticleTile<Dim>& tile, WindowNodes& seen) const;
  int side_of(const State<Dim>& state, int field) const;
  bool velocity_at(const State<Dim>& state, int crack, int side, const Vec<Dim>& x, Vec<Dim>& velocity) const;
  void visit_nodes(Archive& archive);
  void list_segments();
  void list_crossed(const State<Dim>& state, const Supports<Dim>& supports);
  void list_around(const State<Dim>& state, const ParticleTile<Dim>& tile,
                   std::vector<const Segment*>& near) const;
  void cross(const State<Dim>& state, const Supports<Dim>& supports, const ParticleTile<Dim>& tile,
             Room& room, std::vector<Crossed>& out) const;
  void list_nodes(const State<Dim>& state);
  static std::array<WindowBits<Dim>, 2> uncrossed(const WindowNodes& under);
  Seen see(const State<Dim>& state, const Supports<Dim>& supports, std::size_t tile,
           std::vector<Sides>& out) const;
  Seen list_sides(State<Dim>& state, const Supports<Dim>& supports);

  const Scene* scene_;
  std::vector<CrackLine<Dim>> lines_;
  std::vector<int> first_side_;  ///< as Plan
  std::vector<Segment> segments_;
  std::vector<std::array<Vec<Dim>, 2>> boxes_;  ///< around every so many of them
  std::array<Vec<Dim>, 2> all_;                 ///< around all
  std::vector<std::vector<Crossed>> crossed_;   ///< by tile
  std::vector<CrackedNode<Dim>> nodes_;
  std::vector<std::uint64_t> block_keys_;                 ///< of tiles of nodes, rising
  std::vector<std::array<int, kTileNodes<Dim>>> blocks_;  ///< likewise: into nodes_; −1: not cracked
  std::vector<std::vector<Sides>> sides_;              ///< by tile, of the particles that see another than 0
  std::array<std::vector<Vec<Dim>>, 2> velocity_;      ///< of the sides of the line in hand
  std::array<std::vector<std::uint8_t>, 2> is_known_;  ///< likewise
  std::vector<Room> rooms_;                            ///< of each thread
  CrackCounters counters_;
  double drifted_ = HUGE_VAL;  ///< by so much at most since the last look, m
  double moved_ = 0;           ///< since the start
};

extern template class Cracks<2>;
extern template class Cracks<3>;

}  // namespace mpmfast
