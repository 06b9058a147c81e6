// Stresses of a chunk of particles, beside particles that are not the chunk's.

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "kernels/materials/neo_hookean.hpp"
#include "kernels/transfer/strain_chunk.hpp"

namespace mpmfast {
namespace {

/// Particles side by side, all stretched by s along x and each with a stress that marks it.
template <int Dim>
struct Row {
  static constexpr int kParticles = 40, kColumn = kParticles + 8;
  std::vector<double> deformation, stress;
  ParticleView<Dim> view{};

  explicit Row(double stretch) : deformation(Dim * Dim * kColumn), stress(kSymmetric<Dim> * kColumn, -1.0) {
    for (int e = 0; e < Dim * Dim; ++e) {
      view.deformation[e] = deformation.data() + e * kColumn;
      const double value = e == 0 ? stretch : e % (Dim + 1) == 0 ? 1.0 : 0.0;
      for (int p = 0; p < kColumn; ++p) view.deformation[e][p] = value;
    }
    for (int s = 0; s < kSymmetric<Dim>; ++s) view.stress[s] = stress.data() + s * kColumn;
  }
};

template <int Dim>
void check_chunks() {
  const NeoHookean law{1000, 80e6, 30e6};
  constexpr double kStretch = 1.1;
  // τ_xx − τ_yy = G J^(−2/3) (B_xx − B_yy).
  const double difference = 30e6 * std::pow(kStretch, -2.0 / 3) * (kStretch * kStretch - 1);
  for (std::uint32_t begin : {0u, 3u, 16u})
    for (int count = 1; count <= 20; ++count) {
      CAPTURE(begin);
      CAPTURE(count);
      Row<Dim> row(kStretch);
      stress_chunk<Dim>(row.view, law, begin, count);
      for (int p = 0; p < Row<Dim>::kParticles; ++p) {
        const bool inside = p >= static_cast<int>(begin) && p < static_cast<int>(begin) + count;
        if (inside)
          CHECK(row.view.stress[0][p] - row.view.stress[1][p] == doctest::Approx(difference).epsilon(1e-9));
        else
          for (int s = 0; s < kSymmetric<Dim>; ++s) CHECK(row.view.stress[s][p] == -1);
      }
    }
}

TEST_CASE("a chunk's stresses are those of its own particles and no others, however many it has") {
  check_chunks<2>();
  check_chunks<3>();
}

}  // namespace
}  // namespace mpmfast
