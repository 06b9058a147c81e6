#pragma once

/// @file Contact between surfaces that are followed (K24 §3.5, 3.6): what lies of a body's facets below the
/// facets of another is pushed out by springs, at points of integration on them. Both bodies' facets are
/// asked, each with half of the stiffness. Theory: tools/manual/theory.md, "Penalty contact".

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

template <int Dim>
struct Foot;  // kernels/contact/facet_feet.hpp

/// A boundary point where a surface folds onto itself.
struct Fold {
  int body;
  std::uint32_t id;
};

template <int Dim>
class Penalty {
 public:
  /// @param seeded  the state at time 0
  Penalty(const Scene& scene, const Plan& plan, const State<Dim>& seeded);

  bool active() const { return active_; }
  /// After a sort: tiles are others.
  void forget_tiles() { stale_ = true; }

  /// Which points lie below which facets (K24 Eq. 28), where the particles are now.
  /// @return where a surface folds
  std::optional<Fold> look(const State<Dim>& state);
  /// The forces of what look() found; sticking is held by springs that remember.
  /// @param pivots  as Contact::open_books
  void press(const State<Dim>& state, const std::vector<Vec<Dim>>& pivots, double dt);

  /// N, by number of the boundary point.
  const std::vector<Vec<Dim>>& forces() const { return force_; }
  const ContactLedger<Dim>& books() const { return books_; }
  /// Of the springs, where the particles are now, J.
  double stored_energy(const State<Dim>& state);
  /// Points of facets that are pressed, and the most in any step.
  std::size_t pressed() const { return pressed_; }
  std::uint64_t pressed_peak() const { return pressed_peak_; }
  /// The most of the time in which waves cross a cell that a step may take. A spring of ω = s ρc²/Δh on the
  /// mass of a node adds s (c/Δh)² to the squares of its frequencies; rings of s = 1, 4 and 16 gain energy
  /// from 0.75, 0.5 and 0.3 on.
  double stable_share() const { return active_ ? 0.8 / std::sqrt(1 + spec_.stiffness) : kInfinity; }

  /// Of its lists, as they are now.
  std::size_t bytes() const;

  /// What lasts from one step to the next.
  void visit(Archive& archive);

 private:
  /// Points of integration on a facet: two of a segment, exact for cubics; the middle of a triangle (at two
  /// boundary points a cell and more, three gave spheres, cubes and gaps the same errors for twice the time).
  static constexpr int kPoints = Dim == 2 ? 2 : 1;
  static_assert(kPoints == 1 || Dim == 2);
  /// A point of a facet that a piece of another body pushes out, at the nearest of its facets.
  struct Touch {
    int own, at, facet;  ///< its facet, which of its points; the other's facet
    double stiffness;    ///< N/m
    double depth;        ///< m: force over stiffness
    double energy;       ///< J, of all pieces of the body at the first of them; else zero
    Vec<Dim> exit;       ///< unit, the way out
    double share[Dim];   ///< of the facet's points
    Vec<Dim> to_foot;    ///< m
  };
  /// What a touch does.
  struct Pushed {
    Vec<Dim> force;      ///< on its point, N
    Vec<Dim> back[Dim];  ///< on the corners of the other's facet, N
    double lost;         ///< J: what slip beyond the tangential spring takes
    double stored;       ///< J, in that spring
  };
  /// What holds a point that sticks to a piece.
  struct Hold {
    int piece = -1;
    bool slides = false;
    Vec<Dim> stretch = Vec<Dim>::Zero();  ///< m, of the tangential spring
  };
  static constexpr int kHolds = 4;  ///< pieces that a point touches at once
  static constexpr int kNear = 8;   ///< pieces of a body within reach of a point
  struct Holds {
    std::uint64_t step{};  ///< when they were
    std::array<Hold, kHolds> of;
  };
  struct Candidate;
  /// Where a facet is, m: no corner is further from its middle than the radius; its unit normal, its body.
  struct Ball {
    Vec<Dim> middle, normal;
    double radius;
    int body = -1;  ///< −1: it is not known
  };
  struct Binned {
    NodeIndex<Dim> cell;
    int facet, body;
    Ball ball;
  };
  /// A facet and, from begin to end, the facets that may touch it.
  struct Listing {
    int facet, begin, end;
    double clear = 0;  ///< m: by more it was outside of all of them when they were listed; 0 where it was not
  };
  /// Cells that points of two bodies may come closer by until they are listed anew.
  static constexpr double kSkin = 0.4;
  /// Facets of one body among those listed, which of them has its middle nearest to a point, and the squares
  /// of the distances to all, m².
  struct Neighbours {
    int begin, end, nearest;
    const double* squared;
  };
  /// Of a listing, the facets of one body.
  struct Around {
    int body, begin, end;
    int nearest[kPoints];  ///< which has its middle nearest to each point
    double widest;         ///< of their radii, m
  };
  struct Room {
    std::vector<Touch> touches;
    std::vector<Pushed> pushed;   ///< as touches
    std::size_t pressed{};        ///< points that touch
    std::vector<double> squared;  ///< m², of a listing: from each point to each middle
    std::vector<Around> around;   ///< of a listing, by body
    std::vector<Listing> listing;
    std::vector<int> listed;
    int body = -1;                      ///< whose facets look around, from which cell,
    NodeIndex<Dim> cell;                ///< and
    std::vector<const Binned*> binned;  ///< what may be there
    int fold = -1;
  };

  void gather(const State<Dim>& state);
  bool find_near(const State<Dim>& state);
  int find_normals(int threads);
  void find_balls(int threads);
  void fill_bins();
  std::optional<Foot<Dim>> foot_of(const Vec<Dim>& x, const typename Surfaces<Dim>::Facet& facet,
                                   double reach) const;
  void list_bins(const NodeIndex<Dim>& cell, int body, std::vector<const Binned*>& out) const;
  void list_around(int own, Room& room) const;
  void leave_far_ones(const Ball& ball, std::ptrdiff_t begin, std::vector<int>& out) const;
  void list_all(int threads);
  double moved_since_listed() const;
  double clearance(const Listing& listing) const;
  int listed(int k) const { return listed_[static_cast<std::size_t>(k)]; }
  bool look_around(const Listing& listing, Room& room) const;
  bool look_at_body(int own, int k_th, const Vec<Dim>& x, const Neighbours& neighbours, Room& room) const;
  bool touch_body(int own, int k_th, const Vec<Dim>& x, const Candidate* begin, const Candidate* end,
                  std::vector<Touch>& out) const;
  double stiffness_between(int body_a, int body_b) const;
  Vec<Dim> facet_normal(int facet) const;
  void add_couple(const Touch& touch, const Vec<Dim>& force, Vec<Dim> (&back)[Dim]) const;
  Vec<Dim> friction_force(const Touch& touch, Hold& hold, double elapsed, Pushed& pushed) const;
  void push_out(const State<Dim>& state, double elapsed, Room& room);
  const AnyLaw& law_between(int field_a, int field_b) const;
  void book(const Touch& touch, const Pushed& pushed, double dt);
  void book_rigid(int point, const Vec<Dim>& force, const std::vector<Vec<Dim>>& pivots, double dt);
  NodeIndex<Dim> cell_of(const Vec<Dim>& x) const;
  std::size_t bucket_of(const NodeIndex<Dim>& cell) const;
  int field_of(int body) const { return body_field_[static_cast<std::size_t>(body)]; }
  const typename Surfaces<Dim>::Facet& facet(int f) const {
    return surfaces_->facets[static_cast<std::size_t>(f)];
  }
  const Ball& ball(int f) const { return ball_[static_cast<std::size_t>(f)]; }
  const Vec<Dim>& at(int point) const { return now_[static_cast<std::size_t>(point)]; }
  /// Of the k-th point of integration of a facet, of what its corners have.
  Vec<Dim> mean(int f, int k, const std::vector<Vec<Dim>>& of) const {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t c = 0; c < Dim; ++c)
      sum += corner_share(k, static_cast<int>(c)) * of[static_cast<std::size_t>(facet(f).point[c])];
    return sum;
  }
  static double corner_share(int k, int corner) {
    if (kPoints == 1) return 1.0 / Dim;
    return k == corner ? 0.7886751345948129 : 1 - 0.7886751345948129;
  }

  bool active_ = false, stale_ = true, known_ = false;
  const Surfaces<Dim>* surfaces_ = nullptr;
  PenaltySpec spec_;
  double cell_ = 1;         ///< m, of the grid
  double side_ = 1;         ///< m, of a bin
  std::vector<Ball> ball_;  ///< by facet, of the near ones
  std::vector<int> body_field_;
  std::vector<bool> body_rigid_;
  std::vector<double> modulus_;  ///< ρc² by body, Pa
  PairTable pairs_;
  std::vector<AnyLaw> laws_;  ///< the default, then those of ContactSpec::pairs

  std::vector<Vec<Dim>> now_, before_;            ///< positions by number of the point, m
  double time_before_{};                          ///< s
  std::vector<Holds> holds_;                      ///< by number
  std::vector<int> near_points_, near_facets_;    ///< that another field's nodes are near
  std::vector<std::uint8_t> is_near_, near_now_;  ///< by number
  std::vector<std::uint8_t> shared_;              ///< by tile's nodes: with another field
  std::vector<Listing> listing_;                  ///< by facet
  std::vector<int> listed_, listed_wedges_;
  std::vector<Vec<Dim>> listed_at_;  ///< positions by number when they were listed, m
  std::vector<Vec<Dim>> wedge_normal_;
  std::vector<int> bucket_begin_;
  std::vector<Binned> binned_;
  std::vector<Room> rooms_;  ///< by thread
  std::vector<Vec<Dim>> force_;
  ContactLedger<Dim> books_;
  double stretch_energy_ = 0;  ///< of tangential springs, J
  std::size_t pressed_ = 0;
  std::uint64_t pressed_peak_ = 0;
};

extern template class Penalty<2>;
extern template class Penalty<3>;

}  // namespace mpmfast
