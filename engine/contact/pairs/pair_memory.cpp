#include "engine/contact/pairs/pair_memory.hpp"

#include <algorithm>
#include <iterator>

#include "engine/constants.hpp"
#include "engine/contact/geometry/fit_choice.hpp"
#include "engine/state/check_values.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

/// The columns of a fit in a checkpoint: raw normal, normal, two support particles, drift, flags.
template <int Dim>
constexpr std::size_t kFitWidth = 2 * Dim + 4;

/// Fits name particles, of which each must be there.
/// @param separates  a known fit has one on either side
template <int Dim>
void check_fits(Archive& archive, const std::vector<double>& fits, bool separates) {
  std::uint64_t particles = 0;
  archive.number("particles/count", particles);
  check_finite("contact/fits", fits.data(), fits.size());
  constexpr std::size_t kWidth = kFitWidth<Dim>;
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

template <int Dim>
std::uint64_t pair_key(const State<Dim>& state, const ContactList<Dim>& list, const ContactNode<Dim>& node,
                       const ContactPair& pair) {
  constexpr std::uint64_t kCrack = std::uint64_t{1} << 63;
  const auto& block = state.tiling.node_blocks[static_cast<std::size_t>(node.block)];
  const auto tile =
      static_cast<std::uint64_t>(state.tiling.node_tiles[static_cast<std::size_t>(block.begin)].tile_index);
  const auto field = [&](int k) {
    return static_cast<std::uint64_t>(list.fields[node.field_begin + k].field);
  };
  const auto fields = static_cast<std::uint64_t>(state.fields());
  const std::uint64_t at = tile * kTileNodes<Dim> + static_cast<std::uint64_t>(node.local);
  if (pair.crack >= 0)
    return kCrack | (at << 16 | static_cast<std::uint64_t>(2 * pair.crack + (pair.beyond ? 1 : 0)));
  const std::uint64_t other = pair.is_lumped() ? 0 : field(pair.b) + 1;
  return (at * fields + field(pair.a)) * (fields + 1) + other;
}

template <int Dim>
PairMemory<Dim>::PairMemory(const Scene& scene, const Plan& plan, const PairLaws& laws)
    // Lumped pairs come before the explicit ones of their node.
    : in_order_(scene.contact.fields != ManyFields::pairs && scene.cracks.empty()),
      separates_(FitChoice(scene.contact).separate),
      has_springs_(plan.interface_springs),
      has_bonds_(plan.interface_springs &&
                 laws.any([](const AnyLaw& law) { return std::holds_alternative<Cohesive>(law); })),
      has_fits_(plan.keeps_fits) {}

template <int Dim>
void PairMemory<Dim>::store(const ContactList<Dim>& list, int threads) {
  using constants::threads::kFewCopies;
  const PairColumns<Dim>& pairs = list.pairs;
  stored_.resize(pairs.size());
  for_each_of(static_cast<std::int64_t>(pairs.size()), threads, kFewCopies, [&](std::int64_t e) {
    const PairStatus& status = pairs.status[e];
    Stored& stored = stored_[static_cast<std::size_t>(e)];
    stored.key = keys_[static_cast<std::size_t>(e)];
    stored.pair = static_cast<std::uint32_t>(e);
    stored.history = {status.touching, status.stuck, status.recovery_length};
    std::copy(std::begin(pairs.geometry[e].plane), std::end(pairs.geometry[e].plane), stored.plane);
  });
  if (!in_order_)
    std::sort(stored_.begin(), stored_.end(), [](const auto& m, const auto& n) { return m.key < n.key; });
}

template <int Dim>
void PairMemory<Dim>::resize(std::size_t count, ContactList<Dim>& list) {
  PairColumns<Dim>& pairs = list.pairs;
  keys_.resize(count);
  pairs.pair.resize(count);
  pairs.geometry.resize(count);
  pairs.before.resize(count);
  pairs.status.resize(count);
  pairs.impulse.resize(count);
  pairs.relative.resize(count);
  const auto start_anew = [&](bool kept, auto& column, auto& last) {
    if (!kept) return;
    column.swap(last);
    column.resize(count);
  };
  start_anew(has_springs_, pairs.spring, springs_);
  start_anew(has_bonds_, pairs.bond, bonds_);
  start_anew(has_fits_, pairs.fit, fits_);
}

template <int Dim>
void PairMemory<Dim>::restore(std::uint64_t key, std::size_t e, Cursor& cursor, ContactList<Dim>& list) {
  PairColumns<Dim>& pairs = list.pairs;
  keys_[e] = key;
  const auto less = [](const Stored& stored, std::uint64_t of) { return stored.key < of; };
  if (key < cursor.key_before || pairs.pair[e].crack >= 0)
    cursor.at = static_cast<std::size_t>(std::lower_bound(stored_.begin(), stored_.end(), key, less) -
                                         stored_.begin());
  cursor.key_before = key;
  while (cursor.at < stored_.size() && stored_[cursor.at].key < key) ++cursor.at;
  if (cursor.at == stored_.size() || stored_[cursor.at].key != key) return;
  const Stored& stored = stored_[cursor.at];
  pairs.before[e] = stored.history;
  std::copy(std::begin(stored.plane), std::end(stored.plane), pairs.geometry[e].plane);
  if (has_springs_) {
    const DisplacementJump<Dim>& last = springs_[stored.pair].jump;
    DisplacementJump<Dim>& jump = pairs.spring[e].jump;
    jump.value = last.value;
    jump.known = last.known;
    jump.normal = last.normal;
  }
  if (has_bonds_) {
    pairs.bond[e].damage_before = bonds_[stored.pair].damage;
    pairs.bond[e].offset_before = bonds_[stored.pair].offset;
  }
  if (has_fits_) pairs.fit[e] = fits_[stored.pair];
}

template <int Dim>
void PairMemory<Dim>::visit(Archive& archive, ContactList<Dim>& list) {
  archive.list("contact/keys", keys_);
  if (archive.reading()) {
    std::vector<std::uint64_t> keys = keys_;
    resize(keys.size(), list);
    keys_.swap(keys);
  }
  visit_jumps(archive, list.pairs);
  visit_bonds(archive, list.pairs);
  visit_history(archive, list.pairs);
  visit_fits(archive, list.pairs);
}

/// The displacement jumps, each with the normal of the surface that it was seen on.
template <int Dim>
void PairMemory<Dim>::visit_jumps(Archive& archive, PairColumns<Dim>& pairs) const {
  const std::size_t count = has_springs_ ? keys_.size() : 0;
  std::vector<double> jumps(2 * Dim * count);
  std::vector<std::uint8_t> known(count);
  for (std::size_t k = 0; k < count; ++k) {
    const DisplacementJump<Dim>& jump = pairs.spring[k].jump;
    known[k] = jump.known;
    double* out = jumps.data() + 2 * Dim * k;
    std::copy_n(jump.value.data(), Dim, out);
    std::copy_n(jump.normal.data(), Dim, out + Dim);
  }
  archive.column("contact/jumps", jumps.data(), jumps.size());
  archive.column("contact/known_jumps", known.data(), known.size());
  if (!archive.reading()) return;
  check_finite("contact/jumps", jumps.data(), jumps.size());
  for (std::size_t k = 0; k < count; ++k) {
    DisplacementJump<Dim>& jump = pairs.spring[k].jump;
    jump.known = known[k] != 0;
    const double* in = jumps.data() + 2 * Dim * k;
    std::copy_n(in, Dim, jump.value.data());
    std::copy_n(in + Dim, Dim, jump.normal.data());
  }
}

template <int Dim>
void PairMemory<Dim>::visit_bonds(Archive& archive, PairColumns<Dim>& pairs) const {
  if (!has_bonds_) return;
  std::vector<double> bonds((Dim + 1) * keys_.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    double* out = bonds.data() + (Dim + 1) * k;
    std::copy_n(pairs.bond[k].offset.data(), Dim, out);
    out[Dim] = pairs.bond[k].damage;
  }
  archive.column("contact/bonds", bonds.data(), bonds.size());
  if (!archive.reading()) return;
  check_finite("contact/bonds", bonds.data(), bonds.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const double* in = bonds.data() + (Dim + 1) * k;
    std::copy_n(in, Dim, pairs.bond[k].offset.data());
    pairs.bond[k].damage = in[Dim];
  }
}

/// How the pairs touch (bits: touching, stuck), their elastic recovery and the planes of their regressions.
template <int Dim>
void PairMemory<Dim>::visit_history(Archive& archive, PairColumns<Dim>& pairs) const {
  std::vector<std::uint8_t> touching(keys_.size());
  std::vector<double> planes((Dim + 1) * keys_.size()), recovery(keys_.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const PairStatus& status = pairs.status[k];
    touching[k] = static_cast<std::uint8_t>(status.touching | status.stuck << 1);
    recovery[k] = status.recovery_length;
    std::copy_n(pairs.geometry[k].plane, Dim + 1, planes.data() + (Dim + 1) * k);
  }
  archive.column("contact/touching", touching.data(), touching.size());
  archive.column("contact/springs", recovery.data(), recovery.size());
  archive.column("contact/planes", planes.data(), planes.size());
  if (!archive.reading()) return;
  check_finite("contact/springs", recovery.data(), recovery.size());
  check_finite("contact/planes", planes.data(), planes.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    PairStatus& status = pairs.status[k];
    status.recovery_length = recovery[k];
    status.touching = touching[k] & 1;
    status.stuck = touching[k] & 2;
    std::copy_n(planes.data() + (Dim + 1) * k, Dim + 1, pairs.geometry[k].plane);
  }
}

/// Fitted normals that outlast a step, with their support particles.
template <int Dim>
void PairMemory<Dim>::visit_fits(Archive& archive, PairColumns<Dim>& pairs) const {
  if (!has_fits_) return;
  std::vector<double> fits(kFitWidth<Dim> * keys_.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const KeptFit<Dim>& fit = pairs.fit[k];
    double* out = fits.data() + kFitWidth<Dim> * k;
    std::copy_n(fit.raw.data(), Dim, out);
    std::copy_n(fit.normal.data(), Dim, out + Dim);
    out += 2 * Dim;
    *out++ = fit.support[0], *out++ = fit.support[1];
    *out++ = fit.drift;
    *out = fit.known + 2 * fit.overlaps + 4 * fit.doubted;
  }
  archive.column("contact/fits", fits.data(), fits.size());
  if (!archive.reading()) return;
  check_fits<Dim>(archive, fits, separates_);
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    KeptFit<Dim>& fit = pairs.fit[k];
    const double* in = fits.data() + kFitWidth<Dim> * k;
    std::copy_n(in, Dim, fit.raw.data());
    std::copy_n(in + Dim, Dim, fit.normal.data());
    in += 2 * Dim;
    for (auto& particle : fit.support) particle = static_cast<std::int32_t>(*in++);
    fit.drift = *in++;
    const int flags = static_cast<int>(*in);
    fit.known = flags & 1, fit.overlaps = flags & 2, fit.doubted = flags & 4;
  }
}

template std::uint64_t pair_key(const State<2>&, const ContactList<2>&, const ContactNode<2>&,
                                const ContactPair&);
template std::uint64_t pair_key(const State<3>&, const ContactList<3>&, const ContactNode<3>&,
                                const ContactPair&);
template class PairMemory<2>;
template class PairMemory<3>;

}  // namespace mpmfast
