#pragma once

/// @file Heat that is conducted: through bodies, across surfaces that touch, from faces of the grid; and what
/// friction makes of it. All of it is one task of the step, on the weights of its particles before they move
/// (tools/manual/theory.md, "Heat").

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/contact/contact.hpp"
#include "engine/heat/carrier.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// What a run adds up, J.
struct HeatSums {
  std::vector<double> conditions;  ///< came in through them, as HeatSpec::conditions
  double friction = 0;             ///< of contact, that went into bodies that deform
  double rigid = 0;                ///< came in from rigid bodies, which keep their temperature
  double stored = 0;               ///< of all that, in the internal energy of equations of state
  double worked = 0;               ///< became elastic energy by thermal expansion
};

template <int Dim>
class Heat {
 public:
  Heat(const Scene& scene, const Plan& plan);

  bool active() const { return active_; }
  /// The largest time step of conduction, s: ΔtC⁻¹K has no eigenvalue above a half.
  double stable_dt() const { return stable_dt_; }

  /// One step. @return whether all temperatures are positive numbers
  bool advance(State<Dim>& state, HeatCarrier<Dim>& carrier, const Contact<Dim>& contact, double dt);
  /// After a sort: slots have new numbers.
  void invalidate_nodes() { stale_ = true; }

  /// Of a node in the last step, K.
  double temperature(const State<Dim>& state, int slot) const {
    return scale_.reference + state.nodes.column(Nodal::temperature)[slot];
  }
  const HeatSums& sums() const { return sums_; }
  HeatSums& sums() { return sums_; }
  void visit(Archive& archive);

 private:
  /// A node that a condition holds or feeds.
  struct Fed {
    int slot, condition, field;
    NodeIndex<Dim> node;
    /// What is held: T = by_face T_face + Σ by_inner T_inner. Beyond a face it is the mirror image of what is
    /// inside, so that the straight line through both has T_face on the face.
    double by_face = 1;
    std::array<int, 2> inner{};  ///< slots
    std::array<double, 2> by_inner{};
    double end{};  ///< T at the end of the step, from the scene's, K
    /// Inside of a face that holds: the node of the first row at or beyond it, a slot; −1: this is no such
    /// node.
    int across = -1;
  };
  /// Of a surface: its jump, and what drives it.
  struct Jump {
    double jump = 0, drive = 0;
    double wider = 1;  ///< so much more than the node's has the surface
  };
  /// What crosses an entry of the contact list.
  struct Crossing {
    int a = -1, b = -1;  ///< slots; −1: nothing crosses
    std::size_t field_a = 0, field_b = 0;
    bool tied = false;              ///< one temperature for both
    double area{};                  ///< m², of the surface at the node
    std::array<double, 2> sides{};  ///< m², of each side, where a gap is between them
    double conductance{};           ///< W/(m² K)
    double jump{};                  ///< T_b − T_a there, K
    double drive{};                 ///< what all else changes it by, K/s
    Jump mean;                      ///< of both over the nodes around
    bool conducts() const { return area > 0 && conductance > 0; }
  };

  void find_temperatures(State<Dim>& state, Nodal out) const;
  void find_crossings(const State<Dim>& state, const Contact<Dim>& contact);
  double share_of(const State<Dim>& state, const Contact<Dim>& contact, const ContactNode<Dim>& node,
                  int entry) const;
  /// What counts of a conductance, W/(m² K).
  double capped(double conductance) const {
    return std::isinf(conductance) || (stiffest_ > 0 && conductance > stiffest_) ? stiffest_ : conductance;
  }
  Jump mean_jump(const State<Dim>& state, const Contact<Dim>& contact, const ContactNode<Dim>& node,
                 std::size_t entry) const;
  void tie(State<Dim>& state, const Contact<Dim>& contact, Nodal quantity);
  void add_friction_heat(State<Dim>& state, const Contact<Dim>& contact, double dt);
  void cross(State<Dim>& state, const Contact<Dim>& contact, double dt);
  void list_nodes(const State<Dim>& state);
  void mirror(const State<Dim>& state, Fed& fed) const;
  void apply_boundary_flow(State<Dim>& state, const Fed& fed, double dt);
  /// What areas want beside a section: 2π r about an axis, m; else 1.
  static double around(const State<Dim>& state, const NodeIndex<Dim>& node) {
    return state.plane_kind == PlaneKind::axisymmetric
               ? kFullTurn * (state.grid.origin[0] + node[0] * state.grid.cell)
               : 1;
  }
  /// Of a jump, what goes in a step that is x times as long as the jump would last: at most half
  /// (Heat::cross).
  static double shared(double x) { return std::min(-std::expm1(-x), 0.5); }
  /// @param temperature  of a slot, from the scene's, K
  template <class F>
  double held(const Fed& fed, double face, const F& temperature) const {
    double sum = fed.by_face * face;
    for (std::size_t k = 0; k < 2; ++k)
      if (fed.by_inner[k] != 0) sum += fed.by_inner[k] * temperature(fed.inner[k]);
    return sum;
  }
  void feed(State<Dim>& state, double t, double dt);
  void end(State<Dim>& state, double t, double dt);
  void filter(State<Dim>& state, HeatCarrier<Dim>& carrier, const Contact<Dim>& contact);
  bool holds(const Fed& fed) const { return fed.across < 0 && holds(fed.condition); }
  bool holds(int condition) const {
    return scene_->heat.conditions[static_cast<std::size_t>(condition)].kind ==
           HeatConditionSpec::Kind::temperature;
  }

  const Scene* scene_;
  bool active_, crosses_, ties_;
  double stable_dt_{};
  double filter_time_{};   ///< s, from one filter to the next
  double unfiltered_ = 0;  ///< s, since the last one
  double stiffest_{};      ///< W/(m² K): what counts as a perfect conductance
  HeatScale scale_{};
  std::vector<double> effusivity_;  ///< √(k ρ c), by field
  std::vector<bool> rigid_;         ///< by field
  std::vector<Fed> fed_;
  std::vector<int> row_;             ///< by condition: the first row of nodes at or beyond its face
  std::vector<double> plane_;        ///< by condition: where its face is, in cells from the grid's origin
  std::vector<Crossing> crossings_;  ///< as the entries of the contact list
  std::vector<std::vector<int>> workspaces_;  ///< by thread: the groups of a node's fields
  HeatSums sums_;
  bool stale_ = true;
};

extern template class Heat<2>;
extern template class Heat<3>;

}  // namespace mpmfast
