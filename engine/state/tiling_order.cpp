/// The order of the particles: sorted, grouped within places, closed up where some left.

#include <omp.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "engine/constants.hpp"
#include "engine/state/thread_team.hpp"
#include "engine/state/tiling.hpp"

namespace mpmfast {

namespace {

using constants::threads::kFewParticles;

/// Stable radix sort of keys with their order: each thread counts the digits of its stretch, then places them
/// behind those of the stretches before it, so that the result is the same for any number of threads. Digits
/// that no key uses are left out.
void radix_sort(SortBuffers& b, std::uint64_t largest) {
  constexpr int kDigit = SortBuffers::kDigit;
  constexpr std::size_t kValues = std::size_t{1} << kDigit;
  const std::size_t n = b.key.size();
  b.spare.resize(n);
  b.order_spare.resize(n);
  for (int shift = 0; shift < 64 && (largest >> shift) != 0; shift += kDigit) {
    const auto digit = [&](std::size_t i) { return b.key[i] >> shift & (kValues - 1); };
    b.next.resize(static_cast<std::size_t>(omp_get_max_threads()));
    on_threads(n > kFewParticles ? omp_get_max_threads() : 1, [&](const TeamThread& me) {
      const auto threads = static_cast<std::size_t>(me.threads), thread = static_cast<std::size_t>(me.thread);
      auto& mine = b.next[thread];
      mine.fill(0);
      const std::size_t begin = n * thread / threads, end = n * (thread + 1) / threads;
      for (std::size_t i = begin; i < end; ++i) ++mine[digit(i)];
      me.wait_for_all();
      if (thread == 0) {
        std::uint32_t offset = 0;
        for (std::size_t v = 0; v < kValues; ++v)
          for (std::size_t t = 0; t < threads; ++t) offset += std::exchange(b.next[t][v], offset);
      }
      me.wait_for_all();
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t at = mine[digit(i)]++;
        b.spare[at] = b.key[i];
        b.order_spare[at] = b.order[i];
      }
    });
    b.key.swap(b.spare);
    b.order.swap(b.order_spare);
  }
}

/// Puts the column in order, by way of the spare keys: a column of its own to swap with would cost as much
/// memory again. Beyond the ranges all stay where they are.
template <class T>
void permute(T* values, SortBuffers& buffers) {
  static_assert(sizeof(T) <= sizeof(std::uint64_t));
  // The compiler is to know that neither of these moves while it writes.
  const std::uint32_t* const order = buffers.order.data();
  auto* const spare = reinterpret_cast<unsigned char*>(buffers.spare.data());
  for (const auto& range : buffers.ranges) {
    const std::uint32_t begin = range[0], end = range[1];
    on_threads(end - begin > kFewParticles ? omp_get_max_threads() : 1, [=](const TeamThread& me) {
      const auto threads = static_cast<std::uint64_t>(me.threads),
                 thread = static_cast<std::uint64_t>(me.thread), n = static_cast<std::uint64_t>(end - begin);
      const auto first = begin + static_cast<std::uint32_t>(n * thread / threads),
                 last = begin + static_cast<std::uint32_t>(n * (thread + 1) / threads);
      for (std::uint32_t i = first; i < last; ++i)
        std::memcpy(spare + i * sizeof(T), values + order[i], sizeof(T));
      me.wait_for_all();
      std::memcpy(values + first, spare + first * sizeof(T), (last - first) * sizeof(T));
    });
  }
}

}  // namespace

template <int Dim>
void Tiling<Dim>::start_groups() {
  mapped_.clear();
  maps_.clear();
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    if (tile_keys_[t] % static_cast<std::uint64_t>(groups_) == 0) continue;
    const auto begin = runs[static_cast<std::size_t>(tiles[t].run_begin)].begin,
               end = runs[static_cast<std::size_t>(tiles[t].run_end - 1)].end;
    for (std::uint32_t p = begin; p < end; ++p) set_group(p, 0);
  }
}

template <int Dim>
void Tiling<Dim>::set_groups(const ParticleTile<Dim>& tile, const std::vector<SideMap<Dim>>& maps) {
  NodeIndex<Dim> at;
  for (int d = 0; d < Dim; ++d) at[d] = tile.window[d] / kTileSide;
  const auto key =
      static_cast<std::uint64_t>(tile_index(at, tile.field, fields_)) * static_cast<std::uint64_t>(groups_);
  for (std::size_t group = 0; group < maps.size(); ++group) {
    mapped_.push_back(key + group + 1);
    maps_.push_back(maps[group]);
  }
}

template <int Dim>
void Tiling<Dim>::sort(Particles<Dim>& particles) {
  stayed_ = std::is_sorted(buffers_.key.begin(), buffers_.key.end());
  if (stayed_) return;
  const std::size_t n = particles.size();
  buffers_.order.resize(n);
  std::vector<std::uint64_t> largest_of(static_cast<std::size_t>(omp_get_max_threads()));
  on_threads(n > kFewParticles ? omp_get_max_threads() : 1, [&](const TeamThread& me) {
    const auto threads = static_cast<std::size_t>(me.threads), thread = static_cast<std::size_t>(me.thread);
    std::uint64_t most = 0;
    for (std::size_t p = n * thread / threads; p < n * (thread + 1) / threads; ++p) {
      buffers_.order[p] = static_cast<std::uint32_t>(p);
      most = std::max(most, buffers_.key[p]);
    }
    largest_of[thread] = most;
  });
  const std::uint64_t largest = *std::max_element(largest_of.begin(), largest_of.end());
  radix_sort(buffers_, largest);
  std::uint32_t begin = 0, end = static_cast<std::uint32_t>(n);
  while (begin < n && buffers_.order[begin] == begin) ++begin;
  while (end > begin && buffers_.order[end - 1] == end - 1) --end;
  buffers_.ranges.assign(1, {begin, end});
  put_in_order(particles);
}

/// As sort(), where only the order within places is to change.
template <int Dim>
void Tiling<Dim>::sort_by_tile_index(Particles<Dim>& particles) {
  auto &key = buffers_.key, &spare = buffers_.spare;
  auto& order = buffers_.order;
  order.resize(key.size());
  spare.resize(key.size());
  buffers_.ranges.clear();
  for (std::size_t t = 0; t < tiles.size(); t += 1 + static_cast<std::size_t>(tiles[t].others)) {
    const auto last = t + static_cast<std::size_t>(tiles[t].others);
    const std::uint32_t begin = runs[static_cast<std::size_t>(tiles[t].run_begin)].begin,
                        end = runs[static_cast<std::size_t>(tiles[last].run_end - 1)].end;
    if (std::is_sorted(key.begin() + begin, key.begin() + end)) continue;
    std::iota(order.begin() + begin, order.begin() + end, begin);
    std::sort(order.begin() + begin, order.begin() + end,
              [&](auto a, auto b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
    std::uint32_t from = begin, to = end;
    while (order[from] == from) ++from;
    while (order[to - 1] == to - 1) --to;
    buffers_.ranges.push_back({from, to});
  }
  permute(key.data(), buffers_);
  stayed_ = false;
  put_in_order(particles);
}

/// All columns, of the particles in buffers_.ranges.
template <int Dim>
void Tiling<Dim>::put_in_order(Particles<Dim>& particles) {
  for (Quantity q : particles.quantities())
    for (int k = 0; k < Particles<Dim>::components(q); ++k) permute(particles.column(q, k), buffers_);
  permute(particles.id().data(), buffers_);
  permute(particles.body().data(), buffers_);
  if (follows_) note_moves(particles.size());
}

template <int Dim>
void Tiling<Dim>::note_moves(std::size_t particles) {
  auto& to = buffers_.order_spare;
  to.resize(particles);
  std::iota(to.begin(), to.end(), 0U);
  for (const auto& range : buffers_.ranges)
    for (std::uint32_t i = range[0]; i < range[1]; ++i) to[buffers_.order[i]] = i;
}

/// Keeps the particles whose rising numbers are in buffers_.order, with their keys.
template <int Dim>
void Tiling<Dim>::keep_ordered(Particles<Dim>& particles) {
  const std::vector<std::uint32_t>& kept = buffers_.order;
  const auto close_up = [&](auto* values) {
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  };
  for (Quantity q : particles.quantities())
    for (int k = 0; k < Particles<Dim>::components(q); ++k) close_up(particles.column(q, k));
  close_up(particles.id().data());
  close_up(particles.body().data());
  close_up(buffers_.key.data());
  buffers_.key.resize(kept.size());
  particles.keep_first(kept.size());
}

// Here: the members that this file defines.
template void Tiling<2>::start_groups();
template void Tiling<3>::start_groups();
template void Tiling<2>::set_groups(const ParticleTile<2>&, const std::vector<SideMap<2>>&);
template void Tiling<3>::set_groups(const ParticleTile<3>&, const std::vector<SideMap<3>>&);
template void Tiling<2>::sort(Particles<2>&);
template void Tiling<3>::sort(Particles<3>&);
template void Tiling<2>::sort_by_tile_index(Particles<2>&);
template void Tiling<3>::sort_by_tile_index(Particles<3>&);
template void Tiling<2>::put_in_order(Particles<2>&);
template void Tiling<3>::put_in_order(Particles<3>&);
template void Tiling<2>::note_moves(std::size_t);
template void Tiling<3>::note_moves(std::size_t);
template void Tiling<2>::keep_ordered(Particles<2>&);
template void Tiling<3>::keep_ordered(Particles<3>&);

}  // namespace mpmfast
