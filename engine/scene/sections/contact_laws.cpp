#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

/// Hears what the parameters of a law are.
struct Names {
  std::vector<LawParameter>& found;

  void key(const char* name, const char*, double&, const Number&) { found.push_back({name, false}); }
  void need(const char* name, const char*, double&, const Number&) { found.push_back({name, true}); }
};

using Values = std::map<std::string, double>;
/// Takes down the parameters of a law, or gives a law those that are known.
struct Collect {
  Values& values;

  void key(const char* name, const char*, double& member, const Number&) { values[name] = member; }
  void need(const char* name, const char* says, double& member, const Number& form) {
    key(name, says, member, form);
  }
};
struct Give {
  const Values& values;

  void key(const char* name, const char*, double& member, const Number&) {
    if (const auto found = values.find(name); found != values.end()) member = found->second;
  }
  void need(const char* name, const char* says, double& member, const Number& form) {
    key(name, says, member, form);
  }
};

/// The keys of a law: one that has no default may be absent where another law has given it.
struct LawKeys {
  Keys& map;
  bool given;

  void key(const char* name, const char* says, double& member, const Number& form) {
    map.key(name, says, member, form);
  }
  void need(const char* name, const char* says, double& member, const Number& form) {
    if (given)
      map.derived(name, says, member, form);
    else
      map.need(name, says, member, form);
  }
};

template <class Visitor>
void describe(AnyLaw& law, Visitor visitor) {
  std::visit([&](auto& one) { one.describe(visitor); }, law);
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
  Values values;
  AnyLaw copy = law;
  describe(copy, Collect{values});
  const double sliding = values["friction"], resting = values["static_friction"];
  if (resting == 0 || resting >= sliding) return;
  const std::string fault =
      fmt::format("static friction {} is less than sliding friction {}", resting, sliding);
  if (map.stated("static_friction"))
    map.check("static_friction", [&](Slot& slot) { slot.report(fault); });
  else
    map.report(fault);
}

/// All that any law may say.
void tell_laws(Keys& map) {
  for (const ContactLawKind& kind : contact_laws()) {
    AnyLaw law = kind.standard;
    describe(law, LawKeys{map, true});
  }
}

template <std::size_t... K>
std::vector<ContactLawKind> kinds_of(std::index_sequence<K...>) {
  std::vector<ContactLawKind> kinds;
  const auto add = [&]<class Law>(Law law) {
    kinds.push_back({Law::kWord, Law::kSays, law, {}});
    describe(kinds.back().standard, Names{kinds.back().parameters});
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

void describe_law(Keys& map, const char* says, SurfaceLaw& law) {
  const std::size_t inherited = law.acts.index();
  std::size_t index = inherited;
  map.at("law", says, [&](Slot& slot) { slot.choose(index, contact_laws()); });
  if (map.tells()) return tell_laws(map);
  const ContactLawKind& kind = contact_laws()[index];
  if (index != inherited) {
    Values values{{"friction", law.friction}};
    describe(law.acts, Collect{values});
    law.acts = kind.standard;
    describe(law.acts, Give{values});
  }
  describe(law.acts, LawKeys{map, map.writes() || index == inherited});
  if (has(kind, "friction")) {
    Values values;
    describe(law.acts, Collect{values});
    law.friction = values["friction"];
  } else {  // so that --set can choose another law
    map.key("friction", kFrictionSays, law.friction, kCoefficient);
  }
  if (!map.reads()) return;
  refuse_others(map, kind);
  check_friction(map, law.acts);
}

}  // namespace mpmfast
