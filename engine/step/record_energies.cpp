/// What a step adds to the sums, and the energies of the moment.

#include "engine/plan/seed.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

template <int Dim>
void Step<Dim>::record_energies(double dt) {
  const auto timed = clock_.enter(Task::record_energies);
  sums_.boundary_work += conditions_.work();
  sums_.friction_work += conditions_.friction_work();
  for (std::size_t b = 0; b < sums_.boundary_impulse.size(); ++b)
    sums_.boundary_impulse[b] += dt * conditions_.force()[b];
  if (plan_.contact) record_contact(contact_.ledger());
  if (plan_.penalty) record_contact(penalty_.ledger());
  if (loads_.active()) sums_.body_force_work += loads_.work();
}

template <int Dim>
void Step<Dim>::record_contact(const ContactLedger<Dim>& ledger) {
  sums_.friction_work += ledger.friction_work;
  sums_.boundary_work += ledger.rigid_work;
  sums_.interface_loss += ledger.lost;
  for (std::size_t f = 0; f < sums_.rigid_impulse.size(); ++f) {
    sums_.rigid_impulse[f] += ledger.rigid_impulse[f];
    sums_.rigid_moment[f] += ledger.rigid_moment[f];
  }
  for (std::size_t k = 0; k < sums_.pair_impulse.size(); ++k) {
    sums_.pair_impulse[k] += ledger.pair_impulse[k];
    sums_.pair_friction_work[k] += ledger.pair_friction_work[k];
  }
}

template <int Dim>
double Step<Dim>::stored_energy() {
  return mpmfast::stored_energy(state_) + contact_.ledger().stored +
         (state_.step > 0 ? penalty_.stored_energy(state_) : 0) - heat_.sums().stored;
}

template <int Dim>
double Step<Dim>::dissipated_energy() {
  return mpmfast::dissipated_energy(state_);
}

template void Step<2>::record_energies(double);
template void Step<3>::record_energies(double);
template void Step<2>::record_contact(const ContactLedger<2>&);
template void Step<3>::record_contact(const ContactLedger<3>&);
template double Step<2>::stored_energy();
template double Step<3>::stored_energy();
template double Step<2>::dissipated_energy();
template double Step<3>::dissipated_energy();

}  // namespace mpmfast
