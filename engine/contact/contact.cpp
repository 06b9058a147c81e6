#include "engine/contact/contact.hpp"

#include <algorithm>
#include <variant>

#include "engine/contact/nodal/fit.hpp"
#include "engine/plan/contact_law.hpp"

namespace mpmfast {

template <int Dim>
Contact<Dim>::Contact(const Scene& scene, const Plan& plan, const Cracks<Dim>& cracks)
    : spec_(scene.contact),
      cracks_(cracks),
      pairs_(plan.pairs),
      cell_(scene.grid.cell),
      cell_volume_(cell_volume(scene)),
      first_correction_(plan.first_correction),
      one_set_(plan.one_set),
      keep_velocity_change_(plan.paired),
      holds_sticking_(plan.one_set && plan.update == ParticleUpdate::flip),
      first_correction_stays_(plan.first_correction_stays),
      first_share_(plan.first_share),
      geometry_(plan.contact_geometry),
      bridges_(plan.bridges),
      keeps_fits_(plan.keeps_fits),
      fit_(std::make_unique<ContactFit<Dim>>()) {
  together_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  laws_.push_back(law_on(spec_.law, scene));
  for (const ContactPair& pair : spec_.pairs) laws_.push_back(law_on(pair.law, scene));
  for (const CrackSpec& crack : scene.cracks) laws_.push_back(law_on(crack.law, scene));
  bonds_ = bridges_ && std::any_of(laws_.begin(), laws_.end(),
                                   [](const AnyLaw& law) { return std::holds_alternative<Cohesive>(law); });
  solves_in_lanes_ =
      one_set_ && !bridges_ && scene.cracks.empty() &&
      std::all_of(laws_.begin(), laws_.end(), [](const AnyLaw& law) {
        return std::visit([](const auto& l) { return kDryFriction<std::decay_t<decltype(l)>>; }, law);
      });
}

template <int Dim>
Contact<Dim>::~Contact() = default;

template <int Dim>
std::size_t Contact<Dim>::bytes() const {
  std::size_t sum =
      bytes_in(list_.nodes, list_.fields, list_.entries, list_.bridges, list_.bonds, list_.fits,
               list_.node_at, keys_, memory_, last_bridges_, last_bonds_, last_fits_, field_begin_) +
      fit_->bytes();
  for (const auto& listing : listings_) sum += bytes_in(listing.nodes, listing.entries);
  return sum;
}

template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
