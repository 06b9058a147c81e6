#include "engine/step/crowding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/constants.hpp"
#include "engine/contact/pairs/find_pairs.hpp"
#include "engine/scene/text/diagnostic.hpp"

namespace mpmfast {
namespace {

/// Cell and body of each particle, in order of the cells and of the fields in them, each field once.
template <int Dim>
std::vector<std::pair<std::uint64_t, std::uint16_t>> bodies_by_cell(const State<Dim>& state) {
  constexpr std::uint64_t kSpan = std::uint64_t{1} << 20;  // cells along an axis
  std::vector<std::pair<std::uint64_t, std::uint16_t>> list;
  list.reserve(state.particles.size());
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    std::uint64_t cell = 0;
    for (int d = 0; d < Dim; ++d) {
      const double at =
          (state.particles.column(Quantity::position, d)[p] - state.grid.origin[d]) * state.grid.inverse_cell;
      cell = cell * kSpan + static_cast<std::uint64_t>(std::clamp(at + 1, 0.0, kSpan - 1.0));
    }
    list.emplace_back(cell, state.particles.body()[p]);
  }
  const auto key = [&](const auto& one) { return std::pair(one.first, state.body_field[one.second]); };
  std::sort(list.begin(), list.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  list.erase(
      std::unique(list.begin(), list.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }),
      list.end());
  return list;
}

}  // namespace

template <int Dim>
Crowding crowding(const State<Dim>& state, std::size_t fields) {
  Crowding out;
  if (fields <= constants::step::kFewFields) return out;
  const auto list = bodies_by_cell(state);
  for (std::size_t begin = 0, end = 0; begin < list.size(); begin = end) {
    while (end < list.size() && list[end].first == list[begin].first) ++end;
    const auto count = static_cast<double>(end - begin);
    out.pairs += 0.5 * count * (count - 1);
    if (end - begin > out.fields) {
      out.fields = end - begin;
      out.one = list[begin].second;
      out.other = list[end - 1].second;
    }
  }
  return out;
}

template <int Dim>
void check_crowding(const Scene& scene, const State<Dim>& state, std::size_t fields,
                    const MemoryLimit& available) {
  // An entry is listed by a thread, then kept, and remembered with its key until the next step.
  constexpr double kPair = PairFinder<Dim>::kPairBytes + kPairBytes<Dim> + PairMemory<Dim>::kPairBytes;
  if (!scene.contact.active || scene.contact.fields == ManyFields::lump || available.bytes == 0) return;
  const Crowding found = crowding(state, fields);
  if (found.pairs * kPair <= static_cast<double>(available.bytes)) return;
  throw SceneError({Diagnostic{
      scene.file.string(), 0, 0, "bodies",
      fmt::format(
          "up to {} bodies lie in one cell, '{}' and '{}' among them: contact would list {:.2g} pairs of "
          "them in {:.3g} GiB, and there are {:.3g} GiB {}",
          found.fields, scene.bodies[found.one].name, scene.bodies[found.other].name, found.pairs,
          found.pairs * kPair / 1073741824.0, static_cast<double>(available.bytes) / 1073741824.0,
          available.whose),
      "Bodies that are to be apart must not overlap; those that move as one share a field"}});
}

template Crowding crowding(const State<2>&, std::size_t);
template Crowding crowding(const State<3>&, std::size_t);
template void check_crowding(const Scene&, const State<2>&, std::size_t, const MemoryLimit&);
template void check_crowding(const Scene&, const State<3>&, std::size_t, const MemoryLimit&);

}  // namespace mpmfast
