#include <fmt/format.h>
#include <memory>
#include <new>

#include "engine/output/hash.hpp"
#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"

namespace mpmfast {
namespace {

/// XXH3-128 over values gathered in a given order.
class StateHash {
 public:
  explicit StateHash(std::vector<std::uint32_t> order)
      : order_(std::move(order)), state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
  }

  template <class T>
  void add(const T* values) {
    std::vector<T> gathered(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) gathered[i] = values[order_[i]];
    XXH3_128bits_update(state_.get(), gathered.data(), gathered.size() * sizeof(T));
  }

  std::string text() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::vector<std::uint32_t> order_;
  std::unique_ptr<XXH3_state_t, Free> state_;
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
        Quantity::temperature, Quantity::elastic_strain, Quantity::out_of_plane_stretch}) {
    if (!particles.has(quantity)) continue;
    for (int k = 0; k < Particles<Dim>::components(quantity); ++k) hash.add(particles.column(quantity, k));
  }
  return hash.text();
}

template std::string checksum(const Particles<2>&);
template std::string checksum(const Particles<3>&);

}  // namespace mpmfast
