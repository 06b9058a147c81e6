/// What lasts from one step to the next, all of it and nothing else: what a step computes before it reads it
/// (nodes, contact nodes, speeds of boundaries and rigid bodies) is not here.

#include <fmt/format.h>

#include "engine/contact/nodal/fit.hpp"
#include "engine/errors.hpp"
#include "engine/step/check_state.hpp"
#include "engine/step/step.hpp"
#include "engine/step/visit_sums.hpp"

namespace mpmfast {

namespace {

/// What splits make of a particle, at most.
template <int Dim>
constexpr std::uint64_t kMostOfOne = std::uint64_t{1} << (Dim * kMostHalvings);

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

void visit_counters(Archive& archive, ContactCounters& c) {
  archive.number("contact/nodes_peak", c.nodes_peak);
  archive.number("contact/regressions", c.regressions);
  archive.number("contact/iterations", c.iterations);
  archive.number("contact/fallbacks", c.fallbacks);
  archive.number("contact/unconverged", c.unconverged);
  archive.number("contact/touching_normals", c.touching);
  archive.number("contact/doubtful_normals", c.doubtful);
  archive.number("contact/pair_nodes", c.pair_nodes);
  archive.number("contact/pair_fallbacks", c.pair_fallbacks);
  archive.number("contact/meetings", c.meetings);
  archive.number("contact/screened", c.screened);
}

/// Fits name particles, of which each must be there.
/// @param separates  a fit that is known has one on either side
template <int Dim>
void check_fits(Archive& archive, const std::vector<double>& fits, bool separates) {
  std::uint64_t particles = 0;
  archive.number("particles/count", particles);
  check_finite("contact/fits", fits.data(), fits.size());
  constexpr std::size_t kWidth = 2 * Dim + 4;
  for (std::size_t at = 0; at < fits.size(); at += kWidth) {
    const double* fit = fits.data() + at;
    const double flags = fit[kWidth - 1];
    bool good = fit[kWidth - 2] >= 0 && flags >= 0 && flags < 8;
    const bool known = good && static_cast<int>(flags) & 1;
    for (std::size_t side = 0; side < 2; ++side) {
      const double particle = fit[2 * Dim + side];
      good &= particle >= (known && separates ? 0 : -1) && particle < static_cast<double>(particles);
    }
    if (!good) refuse_checkpoint("contact/fits names a particle that is not there");
  }
}

}  // namespace

/// Normals that outlast a step, and the particles that were foremost.
template <int Dim>
void Contact<Dim>::visit_fits(Archive& archive) {
  if (!keeps_fits_) return;
  list_.fits.resize(keys_.size());
  constexpr std::size_t kWidth = 2 * Dim + 4;
  std::vector<double> fits(kWidth * keys_.size());
  const auto for_each_fit = [&](const auto& f) {
    for (std::size_t k = 0; k < keys_.size(); ++k) f(list_.fits[k], fits.data() + kWidth * k);
  };
  for_each_fit([](const auto& fit, double* out) {
    std::copy_n(fit.raw.data(), Dim, out);
    std::copy_n(fit.normal.data(), Dim, out + Dim);
    out += 2 * Dim;
    *out++ = fit.foremost[0], *out++ = fit.foremost[1];
    *out++ = fit.drift;
    *out = fit.known + 2 * fit.touches + 4 * fit.doubted;
  });
  archive.column("contact/fits", fits.data(), fits.size());
  if (archive.reading()) check_fits<Dim>(archive, fits, FitChoice(spec_).separate);
  for_each_fit([](auto& fit, const double* in) {
    std::copy_n(in, Dim, fit.raw.data());
    std::copy_n(in + Dim, Dim, fit.normal.data());
    in += 2 * Dim;
    for (auto& particle : fit.foremost) particle = static_cast<std::int32_t>(*in++);
    fit.drift = *in++;
    const int flags = static_cast<int>(*in);
    fit.known = flags & 1, fit.touches = flags & 2, fit.doubted = flags & 4;
  });
}

/// The next step asks the last one's entries for how they touch (bits: touching, stuck), their planes, how
/// they are pressed alone (remember), their jumps and what is left of their bonds.
template <int Dim>
void Contact<Dim>::visit(Archive& archive) {
  visit_counters(archive, list_.counters);
  archive.number("contact/stored", books_.stored);
  archive.list("contact/keys", keys_);
  list_.entries.resize(keys_.size());
  std::vector<std::uint8_t> touching(keys_.size());
  std::vector<double> planes((Dim + 1) * keys_.size()), springs(keys_.size());
  const auto for_each_entry = [&](const auto& f) {
    for (std::size_t k = 0; k < keys_.size(); ++k)
      f(list_.entries[k], touching[k], springs[k], planes.data() + (Dim + 1) * k);
  };
  for_each_entry([](const auto& entry, std::uint8_t& touch, double& spring, double* plane) {
    spring = entry.spring;
    touch = static_cast<std::uint8_t>(entry.touching | entry.stuck << 1);
    std::copy(entry.plane, entry.plane + Dim + 1, plane);
  });
  std::vector<double> jumps(bridges_ ? 2 * Dim * keys_.size() : 0);  // each with the normal it was seen on
  std::vector<std::uint8_t> known(bridges_ ? keys_.size() : 0);
  if (bridges_) list_.bridges.resize(keys_.size());
  for (std::size_t k = 0; k < known.size(); ++k) {
    known[k] = list_.bridges[k].known;
    const auto& bridge = list_.bridges[k];
    std::copy(bridge.jump.data(), bridge.jump.data() + Dim, jumps.data() + 2 * Dim * k);
    std::copy(bridge.jump_normal.data(), bridge.jump_normal.data() + Dim, jumps.data() + (2 * k + 1) * Dim);
  }
  archive.column("contact/jumps", jumps.data(), jumps.size());
  archive.column("contact/known_jumps", known.data(), known.size());
  if (archive.reading()) check_finite("contact/jumps", jumps.data(), jumps.size());
  for (std::size_t k = 0; k < known.size(); ++k) {
    auto& bridge = list_.bridges[k];
    bridge.known = known[k] != 0;
    const double* jump = jumps.data() + 2 * Dim * k;
    std::copy(jump, jump + Dim, bridge.jump.data());
    std::copy(jump + Dim, jump + 2 * Dim, bridge.jump_normal.data());
  }
  if (bonds_) {
    std::vector<double> bonds((Dim + 1) * keys_.size());
    list_.bonds.resize(keys_.size());
    const auto for_each_bond = [&](const auto& f) {
      for (std::size_t k = 0; k < keys_.size(); ++k) f(list_.bonds[k], bonds.data() + (Dim + 1) * k);
    };
    for_each_bond([](const auto& bond, double* out) {
      out[Dim] = bond.way;
      std::copy(bond.offset.data(), bond.offset.data() + Dim, out);
    });
    archive.column("contact/bonds", bonds.data(), bonds.size());
    if (archive.reading()) check_finite("contact/bonds", bonds.data(), bonds.size());
    for_each_bond([](auto& bond, const double* in) {
      bond.way = in[Dim];
      std::copy(in, in + Dim, bond.offset.data());
    });
  }
  archive.column("contact/touching", touching.data(), touching.size());
  archive.column("contact/springs", springs.data(), springs.size());
  archive.column("contact/planes", planes.data(), planes.size());
  if (archive.reading()) check_finite("contact/springs", springs.data(), springs.size());
  if (archive.reading()) check_finite("contact/planes", planes.data(), planes.size());
  visit_fits(archive);
  for_each_entry([](auto& entry, std::uint8_t touch, double spring, const double* plane) {
    entry.spring = spring;
    entry.touching = touch & 1;
    entry.stuck = touch & 2;
    std::copy(plane, plane + Dim + 1, entry.plane);
  });
}

template <int Dim>
void Step<Dim>::visit(Archive& archive) {
  archive.number("step/time", state_.time);
  archive.number("step/number", state_.step);
  archive.number("step/fastest", fastest_);
  archive.number("step/travelled", travelled_);
  archive.flag("step/sort_due", sort_due_);
  if (plan_.split_edge > 0) {
    archive.number("step/unlooked", unlooked_);
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
  check_places(state_, lower_, upper_);
  state_.nodes.resize(static_cast<std::size_t>(state_.tiling.slots()));
  conditions_.forget_nodes();
  penalty_.invalidate_tiles();
  // Where particles lie in other windows than their tiles', nothing may count on these: the next step sorts.
  const bool placed = passes_->near_home(state_, 0);
  sort_due_ |= !placed;
  if (cracks_.active() && placed) cracks_.mark_tiles(state_, passes_->supports(state_));
}

template void Contact<2>::visit_fits(Archive&);
template void Contact<3>::visit_fits(Archive&);
template void Contact<2>::visit(Archive&);
template void Contact<3>::visit(Archive&);
template void Step<2>::visit(Archive&);
template void Step<3>::visit(Archive&);

}  // namespace mpmfast
