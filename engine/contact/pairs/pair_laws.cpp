#include "engine/contact/pairs/pair_laws.hpp"

#include "engine/plan/contact_law.hpp"

namespace mpmfast {

PairLaws::PairLaws(const Scene& scene, const Plan& plan)
    : table_(plan.pairs),
      listed_(static_cast<int>(scene.contact.pairs.size())),
      by_pair_(!plan.pairs.empty() || !scene.cracks.empty()) {
  laws_.push_back(law_on(scene.contact.law, scene));
  for (const PairLawSpec& pair : scene.contact.pairs) laws_.push_back(law_on(pair.law, scene));
  for (const CrackSpec& crack : scene.cracks) laws_.push_back(law_on(crack.law, scene));
}

}  // namespace mpmfast
