/// All state that persists from step to step, and nothing else: what a step computes before it reads it
/// (nodes, contact nodes, speeds of boundaries and rigid bodies) is not here.

#include <fmt/format.h>

#include "engine/constants.hpp"
#include "engine/errors.hpp"
#include "engine/step/check_state.hpp"
#include "engine/step/step.hpp"
#include "engine/step/visit_sums.hpp"

namespace mpmfast {

namespace {

/// What splits make of a particle, at most.
template <int Dim>
constexpr std::uint64_t kMostOfOne = std::uint64_t{1} << (Dim * constants::splitting::kMostHalvings);

template <int Dim>
void visit_particles(Archive& archive, Particles<Dim>& particles) {
  std::uint64_t n =
      particles.size();  // fewer than were seeded where some have left, more where some were split
  archive.number("particles/count", n);
  const bool split = particles.has(Quantity::domain_share);
  const std::uint64_t most = (split ? kMostOfOne<Dim> : 1) * particles.size();
  if (n > most) throw FileError("the checkpoint has more particles than its scene");
  const auto seeded = archive.reading() ? bodies_by_id(particles) : std::vector<std::uint16_t>();
  if (n > particles.size()) particles.grow(n);
  particles.keep_first(n);
  if (split) archive.number("particles/next_id", particles.next_id());
  if (archive.reading() && particles.next_id() > most)
    refuse_checkpoint("more particles were made than splits can make");
  archive.column("particles/id", particles.id().data(), n);
  archive.column("particles/body", particles.body().data(), n);
  for (const Quantity q : particles.quantities()) {
    const int components = Particles<Dim>::components(q);
    for (int k = 0; k < components; ++k) {
      const std::string_view name = kQuantityTable[static_cast<std::size_t>(q)].name;
      archive.column(
          components > 1 ? fmt::format("particles/{}_{}", name, k) : fmt::format("particles/{}", name),
          particles.column(q, k), n);
    }
  }
  if (archive.reading()) check_particles(particles, seeded);
}

}  // namespace

template <int Dim>
void Step<Dim>::visit(Archive& archive) {
  archive.number("step/time", state_.time);
  archive.number("step/number", state_.step);
  archive.number("step/fastest", fastest_);
  archive.number("step/travelled", travelled_);
  archive.flag("step/sort_due", sort_due_);
  if (plan_.split_edge > 0) {
    archive.number("step/unlooked", unchecked_path_);
    archive.number("step/splits", splits_.splits);
    archive.number("step/split_held", splits_.held);
  }
  archive.number("step/nodes_peak", nodes_peak_);
  if (archive.reading()) {
    check_not_negative("step/time", state_.time);
    check_not_negative("step/fastest", fastest_);
    check_not_negative("step/travelled", travelled_);
  }
  archive.column("step/seconds", clock_.seconds().data(), clock_.seconds().size());
  visit_sums(archive, "sums", sums_);
  if (cracks_.active()) cracks_.visit(archive);
  contact_.visit(archive);
  penalty_.visit(archive);
  heat_.visit(archive);
  conditions_.visit(archive);
  visit_particles(archive, state_.particles);
  state_.tiling.visit(archive, state_.particles, state_.body_field);
  if (!archive.reading()) return;
  if (state_.tiling.tiles.empty() && state_.particles.size() > 0 && !sort_due_)
    refuse_checkpoint("no particle is in a tile");
  check_positions(state_, lower_, upper_);
  state_.nodes.resize(static_cast<std::size_t>(state_.tiling.slots()));
  conditions_.invalidate_nodes();
  penalty_.invalidate_tiles();
  // Where particles lie in other windows than their tiles', nothing may count on these: the next step sorts.
  const bool placed = passes_->near_home(state_, 0);
  sort_due_ |= !placed;
  if (cracks_.active() && placed) cracks_.mark_tiles(state_, passes_->supports(state_));
}

template void Step<2>::visit(Archive&);
template void Step<3>::visit(Archive&);

}  // namespace mpmfast
