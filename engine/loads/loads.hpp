#pragma once

/// @file What acts on bodies from outside: forces on nodes, and their work.

#include <memory>
#include <vector>

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// One load. A step calls both functions once, in this order.
template <int Dim>
class Load {
 public:
  virtual ~Load() = default;
  /// Adds its mean nodal forces f_i over the step from State::time on to Nodal::force, N.
  virtual void add_force(State<Dim>& state, double dt) = 0;
  /// The work of these forces, J, when Nodal::velocity holds v⁺ and Nodal::force a Δt: the nodes have moved
  /// with v⁺ − ½ a Δt, so that it is Δt Σ_i f_i·(v_i⁺ − ½ a_i Δt).
  virtual double work(const State<Dim>& state, double dt) const = 0;
  /// Its force over mass within a velocity field in this step, m/s²; none of what acts on surfaces.
  virtual Vec<Dim> acceleration(int /*field*/) const { return Vec<Dim>::Zero(); }
};

/// All loads of a scene.
template <int Dim>
class Loads {
 public:
  Loads(const Scene& scene, const Plan& plan);

  bool active() const { return !loads_.empty(); }
  void add_force(State<Dim>& state, double dt);
  void find_work(const State<Dim>& state, double dt);
  double work() const { return work_; }  ///< of all loads in this step, J
  Vec<Dim> acceleration(int field) const;

 private:
  std::vector<std::unique_ptr<Load<Dim>>> loads_;
  double work_ = 0;
};

extern template class Loads<2>;
extern template class Loads<3>;

}  // namespace mpmfast
