#include <algorithm>
#include <array>

#include "engine/output/hash.hpp"
#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"

namespace mpmfast {
namespace {

/// XXH3-128 over values gathered in a given order.
class StateHash {
 public:
  explicit StateHash(std::vector<std::uint32_t> order) : order_(std::move(order)) {}

  template <class T>
  void add(const T* values) {
    std::array<T, 4096> gathered;  // of a whole column it would be the most that a run takes
    for (std::size_t begin = 0; begin < order_.size(); begin += gathered.size()) {
      const std::size_t count = std::min(gathered.size(), order_.size() - begin);
      for (std::size_t i = 0; i < count; ++i) gathered[i] = values[order_[begin + i]];
      hash_.add(gathered.data(), count * sizeof(T));
    }
  }
  std::string text() const { return hash_.text(); }

 private:
  std::vector<std::uint32_t> order_;
  Hash128 hash_;
};

}  // namespace

template <int Dim>
std::string checksum(const Particles<Dim>& particles) {
  StateHash hash(order_by_id(particles));
  hash.add(particles.id().data());
  hash.add(particles.body().data());
  for (const Quantity quantity :
       {Quantity::position, Quantity::velocity, Quantity::deformation_gradient, Quantity::kirchhoff_stress,
        Quantity::dissipated_energy, Quantity::internal_energy, Quantity::plastic_strain,
        Quantity::temperature, Quantity::elastic_strain, Quantity::out_of_plane_stretch,
        Quantity::volume_ratio}) {
    if (!particles.has(quantity)) continue;
    for (int k = 0; k < Particles<Dim>::components(quantity); ++k) hash.add(particles.column(quantity, k));
  }
  return hash.text();
}

template <int Dim>
std::string seeding_hash(const Particles<Dim>& particles) {
  Hash128 hash;
  hash.add(particles.id().data(), particles.size() * sizeof(std::uint32_t));
  hash.add(particles.body().data(), particles.size() * sizeof(std::uint16_t));
  for (const Quantity quantity : particles.quantities())
    for (int k = 0; k < Particles<Dim>::components(quantity); ++k)
      hash.add(particles.column(quantity, k), particles.size() * sizeof(double));
  return hash.text();
}

std::string text_hash(const std::string& text) {
  Hash128 hash;
  hash.add(text.data(), text.size());
  return hash.text();
}

template std::string checksum(const Particles<2>&);
template std::string checksum(const Particles<3>&);
template std::string seeding_hash(const Particles<2>&);
template std::string seeding_hash(const Particles<3>&);

}  // namespace mpmfast
