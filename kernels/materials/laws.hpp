#pragma once

/// @file The constitutive laws of this build. To add one: a struct in a header here, its line in the list; a
/// scene, the plan, checkpoints, the schema and `mpmfast list` know it by that.

#include <variant>

#include "kernels/materials/drucker_prager.hpp"
#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/logarithmic_neo_hookean.hpp"
#include "kernels/materials/metal.hpp"
#include "kernels/materials/neo_hookean.hpp"
#include "kernels/materials/rigid.hpp"

/// In the order in which they are listed; laws of one word stand together, that which needs no key first.
// clang-format off
#define MPMFAST_LAWS(law)      \
  law(NeoHookean)              \
  law(LinearElastic)           \
  law(LogarithmicNeoHookean)   \
  law(MieGruneisen)            \
  law(ElasticPlastic)          \
  law(MieGruneisenPlastic)     \
  law(ElasticJohnsonCook)      \
  law(MieGruneisenJohnsonCook) \
  law(DruckerPrager)
// clang-format on

namespace mpmfast {

template <class, class... Laws>
using LawsAfter = std::variant<Laws...>;
#define MPMFAST_COMMA_LAW(law) , law
/// A constitutive law with its parameters.
using Material = LawsAfter<void MPMFAST_LAWS(MPMFAST_COMMA_LAW)>;
/// What a scene may call a material.
using MaterialModel = LawsAfter<void MPMFAST_LAWS(MPMFAST_COMMA_LAW), Rigid>;
#undef MPMFAST_COMMA_LAW

}  // namespace mpmfast
