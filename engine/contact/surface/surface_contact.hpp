#pragma once

/// @file Contact at points of the surface (theory, "Contact at the surface"): the phases of a step, in the
/// order in which contact calls them.

#include "engine/contact/impulses/corrections.hpp"
#include "engine/contact/ledger/contact_ledger.hpp"
#include "engine/contact/surface/find_points.hpp"

namespace mpmfast {

struct PointPass;

template <int Dim>
class SurfaceContact {
 public:
  /// Both must outlive it.
  SurfaceContact(const Scene& scene, const Plan& plan, const PairLaws& laws);

  /// Filled by the fits of the normals, by pair.
  std::vector<SurfaceSample<Dim>>& samples() { return samples_; }

  /// Lists the points of a step. @pre the samples of this step
  void find(const State<Dim>& state, const FreeDirections<Dim>& free, const ContactList<Dim>& contacts);

  /// The three corrections, as those of contact on nodes (Corrections).
  void correct_first(State<Dim>& state, const StepTimes& times);
  void correct_second(State<Dim>& state, const StepTimes& times, const std::vector<Vec<Dim>>& pivots,
                      ContactLedger<Dim>& ledger);
  void correct_re_extrapolated(State<Dim>& state, const StepTimes& times, ContactLedger<Dim>& ledger);

  const SurfaceList<Dim>& points() const { return points_; }
  void visit(Archive& archive, int fields) { memory_.visit(archive, fields); }
  std::size_t bytes() const;

 private:
  void start(const State<Dim>& state);
  void begin_active_set(double cell, double dt);
  void change_nodes(State<Dim>& state, double dt, bool forces) const;

  const PairLaws& laws_;
  CorrectionMethod method_;
  const Conditions<Dim>* conditions_ = nullptr;
  std::vector<SurfaceSample<Dim>> samples_;
  PointFinder<Dim> finder_;
  PointMemory<Dim> memory_;
  SurfaceList<Dim> points_;
};

extern template class SurfaceContact<2>;
extern template class SurfaceContact<3>;

}  // namespace mpmfast
