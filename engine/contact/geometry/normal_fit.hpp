#pragma once

/// @file Normals by fits to the clouds of particles around contact nodes, and separations by the domains of
/// the particles (theory §4).

#include <omp.h>

#include <vector>

#include "engine/contact/contact_basis.hpp"
#include "engine/contact/geometry/fit_slabs.hpp"
#include "engine/contact/geometry/fit_workspace.hpp"
#include "engine/contact/geometry/mean_normals.hpp"
#include "engine/contact/surface/surface_sample.hpp"
#include "engine/state/shares.hpp"

namespace mpmfast {

template <int Dim>
class NormalFit {
 public:
  NormalFit() : workspaces_(static_cast<std::size_t>(omp_get_max_threads())) {}

  /// Finds the normals of all pairs that have none prescribed, and the separations of all, as the scene asks.
  /// @param samples  result, by pair: points of their surfaces; null: none are asked for
  void run(const State<Dim>& state, const ContactSpec& spec, const ContactBasis<Dim>& basis,
           ContactList<Dim>& list, std::vector<SurfaceSample<Dim>>* samples = nullptr);

  std::size_t bytes() const;

 private:
  /// What the nodes of a run have in common.
  struct Run {
    const State<Dim>& state;
    const ContactSpec& spec;
    const ContactBasis<Dim>& basis;
    const FitChoice& choice;
    const MeanNormals<Dim>& mean;
    const DomainView<Dim>& domains;
    std::vector<SurfaceSample<Dim>>* samples;
  };
  /// Where the cloud of a node is kept.
  struct KeptCloud {
    int thread, count;
    std::size_t begin;
  };

  FitWorkspace<Dim>& own_workspace() { return workspaces_[static_cast<std::size_t>(thread_index())]; }
  FieldRanges ranges(const ContactNode<Dim>& node, int count) const {
    return {first_.data() + node.field_begin, node.field_end - node.field_begin, count};
  }
  void fit_slab(const Run& run, std::size_t slab, ContactList<Dim>& list);
  void fit_node(const Run& run, const ContactNode<Dim>& node, const CloudColumns<Dim>& cloud,
                FitWorkspace<Dim>& work, ContactList<Dim>& list);
  void reuse(const State<Dim>& state, const FitChoice& choice, const MeanNormals<Dim>& mean,
             const ContactNode<Dim>& node, ContactList<Dim>& list);
  void find_candidates(const Run& run, const ContactList<Dim>& list, std::size_t first,
                       FitWorkspace<Dim>& work) const;
  void collect(const Run& run, const ContactList<Dim>& list, const ContactNode<Dim>& node,
               const Candidates<Dim>& candidates, CloudWorkspace<Dim>& clouds);
  void take_means(const Run& run, std::size_t slab, ContactList<Dim>& list);
  void sample(const Run& run, const ContactNode<Dim>& node, const CloudColumns<Dim>& cloud, int e,
              const ContactList<Dim>& list) const;
  void count(ContactCounters& counters) const;

  std::vector<FitWorkspace<Dim>> workspaces_;  ///< by thread
  std::vector<RawNormal<Dim>> raw_;            ///< by pair
  std::vector<KeptCloud> kept_;                ///< by contact node
  std::vector<std::uint8_t> due_;              ///< by contact node: it is fitted in this step
  std::vector<int> first_;  ///< as ContactList::fields: where its particles begin in the cloud
  FitSlabs<Dim> slabs_;
  Shares shares_{omp_get_max_threads()};
};

extern template class NormalFit<2>;
extern template class NormalFit<3>;

}  // namespace mpmfast
