#pragma once

/// @file The nodal material velocity fields: a structure of arrays over slots (engine/state/tiling.hpp).

#include <array>
#include <string_view>
#include <vector>

#include "engine/state/columns.hpp"
#include "kernels/dimension.hpp"
#include "kernels/transfer/window.hpp"

namespace mpmfast {

/// Every nodal quantity there is. A plan lists the ones that a scene needs; the others are not allocated.
enum class Nodal {
  mass,
  momentum,
  force,            ///< after the second contact correction: a Δt
  velocity,         ///< for the strain: with conditions; after the update: v⁺
  star,             ///< v*_k of the XPIC recursion, then Δv*_k (k = 1: Δv of the first contact correction)
  next,             ///< what an XPIC pass accumulates
  series,           ///< m (v − v*) of XPIC
  re_extrapolated,  ///< v′: what the particles give back with their new velocities, for the strain
  compression_weight,  ///< Σ S_pi M_p times how far p is pressed: this share of a node moves particles with
                       ///< v⁺
  volume_gradient,     ///< Σ G_pi V_p
  mass_position,       ///< Σ S_pi M_p X_p
  volume,              ///< Σ S_pi V_p
  mass_displacement,   ///< Σ S_pi M_p (X_p − X_p0)
  occupied,            ///< volume of the particles whose supports begin here: in one cell of a spline
  /// Displacements extrapolated along their slopes H_p = I − F_p⁻¹: Σ S_pi M_p (X_p − X_p0 − H_p X_p), X_p
  /// from the grid's origin, and Σ S_pi M_p H_p (entries of H row by row)
  mass_offset,
  mass_slope,
  heat_capacity,       ///< C_i = Σ S_pi M_p c
  heat_content,        ///< Σ S_pi M_p c (T_p − g_p·X_p), T from the scene's, X from the grid's origin
  heat_slope,          ///< Σ S_pi M_p c g_p, g = ∇T
  temperature,         ///< T_i, held where conditions hold it
  heat_flow,           ///< heat that comes to a node, W; then what that warms it in a step, K
  conducting_surface,  ///< Σ G_pi V_p k: where what conducts ends
  temperature_filter,  ///< (I − B)ᵏT of the filter of temperatures
  temperature_series,  ///< their sum
};
inline constexpr int kNodalQuantities = 24;

struct NodalInfo {
  Nodal quantity;
  std::string_view name;
  bool vector, paired;  ///< paired: space for a second vector (v* and Δv*)
  std::string_view reason;
  bool matrix = false;
};

inline constexpr std::array<NodalInfo, kNodalQuantities> kNodalTable{{
    {Nodal::mass, "mass", false, false, "every scene"},
    {Nodal::momentum, "momentum", true, false, "every scene"},
    {Nodal::force, "force", true, false, "every scene"},
    {Nodal::velocity, "velocity", true, false, "every scene"},
    {Nodal::star, "star", true, true, "XPIC"},
    {Nodal::next, "next", true, true, "XPIC"},
    {Nodal::series, "series", true, false, "XPIC"},
    {Nodal::re_extrapolated, "re_extrapolated", true, false, "strain with re-extrapolation"},
    {Nodal::compression_weight, "pressed", false, false, "what moves particles, with re-extrapolation"},
    {Nodal::volume_gradient, "volume_gradient", true, false, "surfaces: normals, areas, loads"},
    {Nodal::mass_position, "mass_position", true, false, "separation by position"},
    {Nodal::volume, "volume", false, false, "normals, screening and contact areas by volume"},
    {Nodal::mass_displacement, "mass_displacement", true, false,
     "separation by displacement, loads on a part of a surface"},
    {Nodal::occupied, "occupied", false, false, "extended splines"},
    {Nodal::mass_offset, "mass_offset", true, false, "displacements of interfaces"},
    {Nodal::mass_slope, "mass_slope", true, false, "displacements of interfaces", true},
    {Nodal::heat_capacity, "heat_capacity", false, false, "heat"},
    {Nodal::heat_content, "heat_content", false, false, "heat"},
    {Nodal::heat_slope, "heat_slope", true, false, "heat"},
    {Nodal::temperature, "temperature", false, false, "heat"},
    {Nodal::heat_flow, "heat_flow", false, false, "heat"},
    {Nodal::conducting_surface, "conducting_surface", true, false, "faces that hold a temperature"},
    {Nodal::temperature_filter, "temperature_filter", false, false, "heat that is filtered"},
    {Nodal::temperature_series, "temperature_series", false, false, "heat that is filtered"},
}};

/// Columns over all slots of all velocity fields.
template <int Dim>
class Nodes {
 public:
  static constexpr int components(Nodal q) {
    const auto& info = kNodalTable[static_cast<std::size_t>(q)];
    return !info.vector ? 1 : info.matrix ? Dim * Dim : info.paired ? 2 * Dim : Dim;
  }

  /// Chooses the columns. @param paired whether v* and Δv* are both carried
  void plan(const std::vector<Nodal>& quantities, bool paired) {
    quantities_ = quantities;
    for (Nodal q : quantities) {
      const bool wide = kNodalTable[static_cast<std::size_t>(q)].paired;
      columns_[index(q)].resize(static_cast<std::size_t>(wide && !paired ? Dim : components(q)));
    }
  }

  /// Capacity for n slots; keeps memory that is already there.
  void resize(std::size_t n) {
    size_ = n;
    for (Nodal q : quantities_)
      for (auto& c : columns_[index(q)]) c.resize_discard(n, n + n / 4);  // a sort seldom allocates
  }

  std::size_t size() const { return size_; }
  /// Columns of q; 0 if it is not planned.
  int width(Nodal q) const { return static_cast<int>(columns_[index(q)].size()); }
  bool has(Nodal q) const { return !columns_[index(q)].empty(); }
  const std::vector<Nodal>& quantities() const { return quantities_; }
  double* column(Nodal q, int k = 0) { return columns_[index(q)][static_cast<std::size_t>(k)].data(); }
  const double* column(Nodal q, int k = 0) const {
    return columns_[index(q)][static_cast<std::size_t>(k)].data();
  }

  Vec<Dim> vector(Nodal q, int slot) const {
    Vec<Dim> v;
    for (int d = 0; d < Dim; ++d) v[d] = column(q, d)[slot];
    return v;
  }
  void set(Nodal q, int slot, const Vec<Dim>& v) {
    for (int d = 0; d < Dim; ++d) column(q, d)[slot] = v[d];
  }

  /// N columns of q for a kernel; null if q is not planned.
  template <int N = Dim>
  NodeColumns<N> columns(Nodal q) {
    NodeColumns<N> view;
    for (int k = 0; k < N; ++k) view.column[k] = has(q) ? column(q, k) : nullptr;
    return view;
  }

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (Nodal q : quantities_)
      for (const auto& c : columns_[index(q)]) sum += c.bytes();
    return sum;
  }

 private:
  static std::size_t index(Nodal q) { return static_cast<std::size_t>(q); }
  std::vector<Nodal> quantities_;
  std::array<std::vector<Column<double>>, kNodalQuantities> columns_;
  std::size_t size_ = 0;
};

}  // namespace mpmfast
