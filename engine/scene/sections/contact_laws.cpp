#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

/// Hands each parameter of a law to a function: a number, or one of some words.
template <class F>
struct Visitor {
  const F& f;

  template <class T, class Form>
  void key(const char* name, const char* description, T& member, const Form& form) const {
    f(name, description, member, form, false);
  }
  template <class T, class Form>
  void need(const char* name, const char* description, T& member, const Form& form) const {
    f(name, description, member, form, true);
  }
};

/// Calls f(name, says, member, form, needed) with each parameter of a law.
template <class F>
void for_each_parameter(AnyLaw& law, const F& f) {
  const Visitor<F> visitor{f};
  std::visit([&](auto& one) { one.describe(visitor); }, law);
}

/// Of a parameter: a number, the place of a word, or a curve.
using ParameterValue = std::variant<double, TractionCurve>;
using Values = std::map<std::string, ParameterValue>;

ParameterValue kept(const TractionCurve& curve) { return curve; }
template <class T>
ParameterValue kept(T member) {
  return static_cast<double>(member);
}
void restore(TractionCurve& member, const ParameterValue& value) { member = std::get<TractionCurve>(value); }
template <class T>
void restore(T& member, const ParameterValue& value) {
  member = static_cast<T>(std::get<double>(value));
}

/// The parameters of a law by name.
Values values_of(AnyLaw law) {
  Values values;
  for_each_parameter(law, [&](const char* name, const char*, const auto& member, const auto&, bool) {
    values[name] = kept(member);
  });
  return values;
}

/// One of them that is a number; 0 where the law has none of this name.
double number_of(const AnyLaw& law, const std::string& name) {
  const Values values = values_of(law);
  const auto found = values.find(name);
  return found == values.end() ? 0 : std::get<double>(found->second);
}

/// The keys of a law: one that has no default may be absent where another law has given it.
void describe_parameters(Keys& map, bool given, AnyLaw& law) {
  for_each_parameter(
      law, [&](const char* name, const char* description, auto& member, const auto& form, bool needed) {
        if (!needed)
          map.key(name, description, member, form);
        else if (given)
          map.derived(name, description, member, form);
        else
          map.need(name, description, member, form);
      });
}

bool has(const ContactLawKind& kind, const std::string& name) {
  return std::any_of(kind.parameters.begin(), kind.parameters.end(),
                     [&](const LawParameter& parameter) { return parameter.name == name; });
}

/// Parameters that are stated and belong to other laws. Friction may stand beside any.
void refuse_others(Keys& map, const ContactLawKind& kind) {
  for (const std::string& name : contact_parameters())
    if (name != "friction" && !has(kind, name))
      map.check(name,
                [&](Slot& slot) { slot.report(fmt::format("the law '{}' has no {}", kind.name, name)); });
}

void check_friction(Keys& map, const AnyLaw& law) {
  const double sliding = number_of(law, "friction"), resting = number_of(law, "static_friction");
  if (resting == 0 || resting >= sliding) return;
  const std::string fault =
      fmt::format("static friction {} is less than sliding friction {}", resting, sliding);
  if (map.stated("static_friction"))
    map.check("static_friction", [&](Slot& slot) { slot.report(fault); });
  else
    map.report(fault);
}

/// A bond that has its strength has no more energy than it may take.
void check_toughness(Keys& map, const AnyLaw& law) {
  const auto* bond = std::get_if<Cohesive>(&law);
  if (!bond || bond->initial_stiffness == 0 || bond->initial_stiffness >= bond->least_stiffness()) return;
  map.check("initial_stiffness", [&](Slot& slot) {
    slot.complain(
        fmt::format("too soft: with these strengths it has more energy than breaks it; at least "
                    "{:.4g} Pa/m was expected",
                    bond->least_stiffness()));
  });
}

/// A curve passes through [0, 0] and never drives: springs give back what they took.
void check_curve(Keys& map, const char* name, const TractionCurve& curve, bool overlaps) {
  map.check(name, [&](Slot& slot) {
    const auto origin = std::find(curve.jump.begin(), curve.jump.end(), 0.0) - curve.jump.begin();
    const auto n = static_cast<std::size_t>(origin);
    if (!overlaps && curve.jump.front() != 0) return slot.report("the first point must be [0, 0]");
    if (n == curve.jump.size() || curve.traction[n] != 0)
      return slot.report("a point [0, 0] was expected: whole surfaces carry nothing");
    for (std::size_t k = 0; k < curve.jump.size(); ++k)
      if (curve.jump[k] * curve.traction[k] < 0)
        slot.refuse_item(k,
                         "a traction against the jump was expected: positive where surfaces are apart, "
                         "negative where they overlap");
  });
}

void check_curves(Keys& map, const AnyLaw& law) {
  const auto* curves = std::get_if<NonlinearInterface>(&law);
  if (!curves || !map.good()) return;
  check_curve(map, "normal_curve", curves->normal_curve, true);
  check_curve(map, "shear_curve", curves->shear_curve, false);
  const bool said_twice =
      curves->compression != CompressionModel::spring || curves->compression_stiffness > 0;
  if (!curves->has_overlap() || !said_twice) return;
  const char* name =
      curves->compression != CompressionModel::spring ? "compression" : "compression_stiffness";
  map.check(map.stated(name) ? name : "normal_curve", [&](Slot& slot) {
    slot.report(fmt::format("normal_curve says already what overlap does, {} does too", name),
                map.stated(name) ? "" : "It is that of `contact`");
  });
}

/// All that any law may say.
void register_laws(Keys& map) {
  for (const ContactLawKind& kind : contact_laws()) {
    AnyLaw law = kind.standard;
    describe_parameters(map, true, law);
  }
}

template <std::size_t... K>
std::vector<ContactLawKind> kinds_of(std::index_sequence<K...>) {
  std::vector<ContactLawKind> kinds;
  const auto add = [&]<class Law>(Law law) {
    kinds.push_back({Law::kKeyword, Law::kDescription, law, {}});
    for_each_parameter(kinds.back().standard,
                       [&](const char* name, const char*, const auto&, const auto&, bool needed) {
                         kinds.back().parameters.push_back({name, needed});
                       });
  };
  (add(std::variant_alternative_t<K, AnyLaw>{}), ...);
  return kinds;
}

}  // namespace

const std::vector<ContactLawKind>& contact_laws() {
  static const auto kKinds = kinds_of(std::make_index_sequence<std::variant_size_v<AnyLaw>>());
  return kKinds;
}

std::vector<std::string> contact_parameters() {
  std::vector<std::string> names;
  for (const ContactLawKind& law : contact_laws())
    for (const LawParameter& parameter : law.parameters)
      if (std::find(names.begin(), names.end(), parameter.name) == names.end())
        names.push_back(parameter.name);
  return names;
}

/// How heat crosses what touches.
void describe_conductance(Keys& map, bool heat, ConductanceSpec& conductance) {
  constexpr const char* kDescription =
      "How heat crosses surfaces that touch: perfect, none, or so much a kelvin that they differ by.";
  if (map.writes() && !heat) return;
  map.at("conductance", kDescription, [&](Slot& slot) {
    if (slot.is_keyword("perfect", std::isinf(conductance.touching))) {
      conductance.touching = kInfinity;
    } else if (slot.is_keyword("none", conductance.touching == 0)) {
      conductance.touching = 0;
    } else {
      slot.take(conductance.touching, Number{Measure::conductance, kPositive});
    }
  });
  map.key("gap_conductivity", "Heat conductivity of what fills a gap of up to a cell between them.",
          conductance.gap, Number{Measure::conductivity, kNotNegative});
}

void describe_law(Keys& map, const char* description, bool heat, SurfaceLaw& law) {
  describe_conductance(map, heat, law.conductance);
  describe_tractions(map, description, law);
}

void describe_tractions(Keys& map, const char* description, SurfaceLaw& law) {
  const std::size_t inherited = law.acts.index();
  std::size_t index = inherited;
  map.at("law", description, [&](Slot& slot) { slot.choose(index, contact_laws()); });
  if (map.describes()) return register_laws(map);
  const ContactLawKind& kind = contact_laws()[index];
  if (index != inherited) {
    Values known = values_of(law.acts);
    known.emplace("friction", kept(law.friction));
    law.acts = kind.standard;
    for_each_parameter(law.acts, [&](const char* name, const char*, auto& member, const auto&, bool) {
      if (known.contains(name)) restore(member, known[name]);
    });
  }
  describe_parameters(map, map.writes() || index == inherited, law.acts);
  if (has(kind, "friction")) {
    law.friction = number_of(law.acts, "friction");
  } else {  // so that --set can choose another law
    map.key("friction", kFrictionDescription, law.friction, kCoefficient);
  }
  if (!map.reads()) return;
  refuse_others(map, kind);
  check_friction(map, law.acts);
  check_toughness(map, law.acts);
  check_curves(map, law.acts);
}

}  // namespace mpmfast
