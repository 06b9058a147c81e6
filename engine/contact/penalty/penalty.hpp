#pragma once

/// @file Penalty contact between surfaces (K24 §3.5, 3.6). Points of integration on the facets of each body
/// that are inside another body are pushed out by springs. The facets of both bodies are asked, each with
/// half of the stiffness: no master, no slave. Theory: tools/manual/theory.md, "Penalty contact".

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/contact/penalty/detection.hpp"
#include "engine/contact/penalty/friction.hpp"
#include "engine/state/archive.hpp"

namespace mpmfast {

/// A boundary point where a surface is folded onto itself.
struct Fold {
  int body;
  std::uint32_t id;  ///< of the particle
};

template <int Dim>
class Penalty {
 public:
  /// @param seeded  the state at time 0, whose surfaces this refers to
  Penalty(const Scene& scene, const Plan& plan, const State<Dim>& seeded);

  bool active() const { return active_; }
  /// To call after a sort of the particles.
  void invalidate_tiles() { detection_.invalidate_tiles(); }

  /// Finds the points of integration that are inside another body (K24 Eq. 28).
  /// @return where a surface is folded onto itself, in which case there are no forces to compute
  std::optional<Fold> find_contacts(const State<Dim>& state);
  /// Computes the forces of the contacts found, and records what they do in the step.
  /// @param pivots  of rigid bodies, by velocity field, m
  void compute_forces(const State<Dim>& state, const std::vector<Vec<Dim>>& pivots, double dt);

  /// By boundary point, N.
  const std::vector<Vec<Dim>>& forces() const { return forces_; }
  const ContactLedger<Dim>& ledger() const { return ledger_; }
  /// Energy of the springs at the positions of the particles, J. It finds contacts anew.
  double stored_energy(const State<Dim>& state);
  /// Points of integration in contact in this step, and the most in any step.
  std::size_t contact_points() const { return sums_.points; }
  std::uint64_t contact_points_peak() const { return sums_.points_peak; }
  /// Largest stable Courant number, –: steps over the time in which a wave crosses a cell.
  double courant_limit() const;

  std::size_t bytes() const;

  /// Stores or restores the state that persists from step to step.
  void visit(Archive& archive);

 private:
  /// Positions of boundary points, m.
  struct Positions {
    std::vector<Vec<Dim>> current, previous;
    double time_previous{};  ///< s
    bool known = false;      ///< previous ones are
  };
  struct Sums {
    double tangential_energy = 0;  ///< of the tangential springs, J
    std::size_t points = 0;        ///< in contact
    std::uint64_t points_peak = 0;
  };

  penalty::SurfaceGeometry<Dim> current() const { return {*surfaces_, positions_.current}; }
  penalty::SurfaceGeometry<Dim> previous() const { return {*surfaces_, positions_.previous}; }
  void record(const std::vector<Vec<Dim>>& pivots, double dt);

  bool active_;
  const Surfaces<Dim>* surfaces_;
  penalty::BodyPairs pairs_;
  Positions positions_;
  penalty::ContactDetection<Dim> detection_;
  std::vector<penalty::ThreadContacts<Dim>> contacts_;  ///< by thread
  penalty::FrictionHistory<Dim> history_;
  std::vector<Vec<Dim>> forces_;
  ContactLedger<Dim> ledger_;
  Sums sums_;
};

extern template class Penalty<2>;
extern template class Penalty<3>;

}  // namespace mpmfast
