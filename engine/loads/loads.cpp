#include "engine/loads/loads.hpp"

#include <variant>

namespace mpmfast {

// The kinds of load, each defined in its own file. A new one has its line here.
template <int Dim>
std::unique_ptr<Load<Dim>> make_gravity(const Scene& scene, const Plan& plan);
template <int Dim>
std::unique_ptr<Load<Dim>> make_load(const PressureSpec& spec, const Scene& scene, const Plan& plan);

template <int Dim>
Loads<Dim>::Loads(const Scene& scene, const Plan& plan) {
  if (plan.gravity) loads_.push_back(make_gravity<Dim>(scene, plan));
  for (const LoadSpec& load : scene.loads)
    loads_.push_back(std::visit([&](const auto& spec) { return make_load<Dim>(spec, scene, plan); }, load));
}

template <int Dim>
void Loads<Dim>::add_force(State<Dim>& state, double dt) {
  for (const auto& load : loads_) load->add_force(state, dt);
}

template <int Dim>
void Loads<Dim>::find_work(const State<Dim>& state, double dt) {
  work_ = 0;
  for (const auto& load : loads_) work_ += load->work(state, dt);
}

template <int Dim>
Vec<Dim> Loads<Dim>::acceleration(int field) const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const auto& load : loads_) sum += load->acceleration(field);
  return sum;
}

template class Loads<2>;
template class Loads<3>;

}  // namespace mpmfast
