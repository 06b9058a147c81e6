#pragma once

/// @file What the kernels see of the engine's memory: pointers and sizes, nothing owned.

#include <cstdint>

#include "kernels/basis/weights.hpp"
#include "kernels/constants.hpp"

namespace mpmfast {

/// Pointers to the columns of evolving material state (materials/evolving.hpp).
template <int Dim>
struct StateView {
  double *dissipated, *internal_energy, *plastic_strain, *temperature;
  double* elastic_strain[kSymmetric<Dim>];
  double* volume_ratio;               ///< J; null where every law is elastic
  double* thermal_stretch = nullptr;  ///< θ, of a length by heat since the start: laws see F/θ
};

/// Pointers to the particle columns (SI); those that a plan does not allocate are null.
template <int Dim>
struct ParticleView {
  double* position[Dim];
  double* velocity[Dim];
  double* deformation[Dim * Dim];   ///< row-major F
  double* stress[kSymmetric<Dim>];  ///< Kirchhoff
  double* edges[Dim * Dim];         ///< half-edge vectors of CPDI domains
  double* reference_position[Dim];
  double* initial_deformation[Dim * Dim];  ///< row-major F where domains lie at an angle at the start
  double* domain_share[Dim];               ///< of the body's undeformed domains, by direction
  double* slopes[Dim * Dim];               ///< of the velocity about the particle, row-major (APIC)
  double* mass;
  double* volume;  ///< undeformed
  double* wave_speed;
  double* stretch;                 ///< along the plane's normal
  double* temperature_slope[Dim];  ///< ∇T, K/m
  StateView<Dim> state;
  PlaneKind plane_kind;
};

/// The columns of particles that tell where their domains lie, to be read; null as in ParticleView.
template <int Dim>
struct DomainView {
  const double* position[Dim];
  const double* deformation[Dim * Dim];
  const double* edges[Dim * Dim];
  const double* domain_share[Dim];
};

/// Consecutive particles of one body in one tile, sorted by cell.
template <int Dim>
struct ParticleRun {
  std::uint32_t begin, end;
  std::uint32_t cell_begin[kTileNodes<Dim> + 1];  ///< first particle of each cell when last sorted
  int body;
  bool on_surface;  ///< they are boundary points
};

/// The particles of one velocity field whose supports begin in one tile of nodes, and the nodes they touch.
/// Where a crack runs through, those that see the same side of it on every node: several such tiles follow
/// each other.
template <int Dim>
struct ParticleTile {
  int field;
  int run_begin, run_end;   ///< into the list of runs
  int window[Dim];          ///< node coordinates of the window's first node
  int slot[kCorners<Dim>];  ///< first slot of each node tile under the window
  int others{};             ///< tiles of the same place and field that follow
  bool cracked = false;     ///< its particles reach nodes where others are behind a crack, or soon will
  /// Where nodes take the side of a crack: the slot of each under the window; else null.
  const int* node_slot = nullptr;
};

template <int Dim>
struct GridView {
  double origin[Dim];  ///< m, of node (0, …, 0)
  double cell, inverse_cell;
};

/// What conduction knows of a body (transfer/heat.hpp).
struct BodyHeat {
  double capacity{};            ///< c, J/(kg K)
  double conductivity{};        ///< k, W/(m K)
  double expansion{};           ///< α, of a length, 1/K
  double start{};               ///< temperature at the start, at which heat has not stretched it, K
  double stored{};              ///< ρ0 c where an equation of state holds the heat, J/(m³ K); else 0
  bool elastic_volume = false;  ///< the elastic strain of its law has the volume in it
};

/// What a transfer knows of a body.
template <int Dim>
struct BodyView {
  double half_size[Dim];  ///< m, of its particles' undeformed domains
  int material;
  bool rigid;
  BodyHeat heat{};
};

/// Everything that the transfers of one tile read beside the nodal columns.
/// @tparam View  ParticleView, or DomainView where particles are read only
template <int Dim, class View = ParticleView<Dim>>
struct TileContext {
  const View* particles;
  const ParticleTile<Dim>* tile;
  const ParticleRun<Dim>* runs;
  const BodyView<Dim>* bodies;
  const GridView<Dim>* grid;
  const ParticleTile<Dim>* next = nullptr;  ///< that the thread comes to then, if any
  /// Sums go on from the tile before in its window, and to the next one (transfer/window.hpp).
  bool goes_on_from = false, goes_on_to = false;
};

template <int Dim, class View>
inline ChunkGeometry<Dim> chunk_geometry(const TileContext<Dim, View>& c, const ParticleRun<Dim>& run,
                                         std::uint32_t begin, int count) {
  ChunkGeometry<Dim> g;
  for (int d = 0; d < Dim; ++d) {
    g.position[d] = c.particles->position[d] + begin;
    g.half_size[d] = c.bodies[run.body].half_size[d];
    g.origin[d] = c.grid->origin[d];
    g.window[d] = c.tile->window[d];
  }
  for (int e = 0; e < Dim * Dim; ++e)
    g.edge[e] = c.particles->edges[e] ? c.particles->edges[e] + begin : nullptr;
  g.inverse_cell = c.grid->inverse_cell;
  g.count = count;
  return g;
}

/// Workspace for the weights of one chunk on any support of a basis.
template <int Dim, class Basis>
struct WeightWorkspace {
  alignas(64) typename Basis::template Weights<Basis::kMinSupport> narrow;
  alignas(64) typename Basis::template Weights<Basis::kMaxSupport> wide;
};

/// Stages the wanted weights of a chunk. @return false if a support needs more nodes, or leaves the window
template <class Basis, int Dim, class Weights>
inline bool stage(Wanted wanted, const ChunkGeometry<Dim>& g, Weights& out) {
  switch (wanted) {
    case Wanted::values:
      return Basis::template stage<Wanted::values>(g, out);
    case Wanted::gradients:
      return Basis::template stage<Wanted::gradients>(g, out);
    case Wanted::both:
      break;
  }
  return Basis::template stage<Wanted::both>(g, out);
}

/// Stages each chunk of the run, with the weights that are wanted, and calls f(weights, run, begin, count).
/// @return false if a particle's support left the window (the rest of the run is then skipped).
template <int Dim, class Basis, class F>
inline bool for_each_chunk_of_run(const TileContext<Dim>& c, const ParticleRun<Dim>& run,
                                  WeightWorkspace<Dim, Basis>& workspace, Wanted wanted, F f) {
  for (std::uint32_t begin = run.begin; begin < run.end; begin += kChunk<Dim>) {
    const int count = static_cast<int>(run.end - begin < kChunk<Dim> ? run.end - begin : kChunk<Dim>);
    const ChunkGeometry<Dim> g = chunk_geometry(c, run, begin, count);
    if (stage<Basis>(wanted, g, workspace.narrow))
      f(workspace.narrow, run, begin, count);
    else if (Basis::kMaxSupport > Basis::kMinSupport && stage<Basis>(wanted, g, workspace.wide))
      f(workspace.wide, run, begin, count);
    else
      return false;
  }
  return true;
}

/// Asks for the particles that follow a chunk, mostly those of the next tile: a pass goes along more columns
/// than the processor follows by itself. It asks for a line or two beside the work on each particle: all at
/// once they would wait for each other, and whatever is read meanwhile for them.
/// @tparam N  columns, at most; two beyond a multiple of eight are left to the processor, which follows a few
template <int N>
class FetchAhead {
 public:
  template <int M>
  void add(double* const (&columns)[M]) {
    for (const double* column : columns) add(column);
  }
  void add(const double* column) {
    if (count_ == 0)
      for (const double*& any : columns_) any = column;
    if (count_ < kSlots) columns_[count_++] = column;
  }
  /// @param end  of the chunk
  void start_at(std::uint32_t end) {
    for (unsigned c = 0; c < kSlots; ++c) from_[c] = columns_[c] + end;
  }
  /// Beside the k-th of the chunk. (Always inline: what only asks is a call without effect, and left out.)
  [[gnu::always_inline]] void operator()(int k) const {
    const unsigned at = static_cast<unsigned>(k), of_line = at % kLine;
    for (unsigned c = of_line; c < kSlots; c += kLine) __builtin_prefetch(from_[c] + (at - of_line));
  }

 private:
  static constexpr unsigned kLine = 64 / sizeof(double), kLeft = 2,
                            kSlots = N > kLine ? (N - kLeft + kLine - 1) / kLine *kLine : kLine;
  const double* columns_[kSlots];  ///< those that nothing was added to are the first
  const double* from_[kSlots];     ///< after the chunk
  unsigned count_ = 0;
};

/// The same, with the columns that weights are made of.
/// @tparam N  others, at most
template <class Basis, int N, int Dim>
inline auto fetch_ahead(const ParticleView<Dim>& p) {
  FetchAhead<Dim + (Basis::kConvected ? Dim * Dim : 0) + N> ahead;
  ahead.add(p.position);
  if constexpr (Basis::kConvected) ahead.add(p.edges);
  return ahead;
}

/// The same in a loop over vectors of particles, where it takes an instruction a line and nothing else.
template <int N>
[[gnu::always_inline]] inline void fetch_further(double* const (&columns)[N], std::uint32_t at) {
  for (const double* column : columns) __builtin_prefetch(column + at + constants::kFetchAhead);
}

/// Asks for the tile after the next one, and the runs of the next.
template <int Dim>
[[gnu::always_inline]] inline void fetch_next_tile(const TileContext<Dim>& c) {
  if (!c.next) return;
  __builtin_prefetch(c.next + 1);
  const ParticleRun<Dim>& run = c.runs[c.next->run_begin];
  __builtin_prefetch(&run.begin);
  __builtin_prefetch(&run.body);
}

/// As for_each_chunk_of_run, of all runs of the tile.
template <int Dim, class Basis, class F>
inline bool for_each_chunk(const TileContext<Dim>& c, WeightWorkspace<Dim, Basis>& workspace, Wanted wanted,
                           F f) {
  for (int r = c.tile->run_begin; r < c.tile->run_end; ++r)
    if (!for_each_chunk_of_run<Dim, Basis>(c, c.runs[r], workspace, wanted, f)) return false;
  return true;
}

}  // namespace mpmfast
