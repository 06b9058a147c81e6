#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

/// Names of bodies that are stated and have not become bodies.
std::vector<std::string> unread_bodies(Keys& top, const Scene& scene) {
  std::vector<std::string> out;
  const auto bodies = top.stated("bodies");
  if (!bodies || !bodies->is(Node::Kind::list)) return out;
  std::set<std::string> read;
  for (const BodySpec& body : scene.bodies) read.insert(body.name);
  for (const Node& entry : bodies->node().items) {
    const Node* stated = find_value(entry, "name");
    if (!stated || !is_name(stated->scalar) || read.contains(stated->scalar)) continue;
    const std::string& name = stated->scalar;
    const bool bitmap = find_value(entry, "bitmap");
    const bool level =
        std::any_of(read.begin(), read.end(), [&](const auto& one) { return one.starts_with(name + "_"); });
    if (!bitmap || !level) out.push_back(name);
  }
  return out;
}

/// Describes the entries one by one; those that are read are held against the bodies and the pairs before.
class PairEntries {
 public:
  /// @param unread  names of bodies that the scene states but that could not be read
  PairEntries(Scene& scene, std::vector<std::string> unread)
      : scene_(scene), materials_(names_of(scene.materials)), unread_(std::move(unread)) {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) name(scene.bodies[b].name, b);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) name(scene.bodies[b].field, b);
  }

  void describe(Slot& entry, PairLawSpec pair) {
    constexpr const char* kExpected = "a map {between: [BODY, BODY] or materials: [NAME, NAME], law, …}";
    bool named = false;
    entry.map(kExpected, [&](Keys& map) {
      const auto choice = map.one_of({{"between"}, {"materials"}}, pair.materials ? 1 : 0);
      if (choice.none()) map.report("a pair is either between two bodies or of two materials");
      if (choice.takes(0))
        map.need_at("between", "Two bodies, by name.", "two bodies",
                    [&](Slot& slot) { describe_two(slot, false, pair); });
      if (choice.takes(1))
        map.need_at("materials", "Two materials; also one and the same. A pair of bodies counts before it.",
                    "two materials", [&](Slot& slot) { describe_two(slot, true, pair); });
      named = map.good();
      describe_law(map, "The law of this pair; what it leaves out is that of `contact`.", scene_.heat.active,
                   pair.law);
      if (!map.reads() || !named) return;
      map.check(pair.materials ? "materials" : "between", [&](Slot& who) {
        check(who, pair);
        named = who.good();
      });
    });
    if (entry.reads() && named) scene_.contact.pairs.push_back(pair);
  }

 private:
  /// A velocity field is named by any of its bodies, or by its own name.
  void name(const std::string& text, std::size_t body) {
    if (std::find(names_.begin(), names_.end(), text) != names_.end()) return;
    names_.push_back(text);
    body_.push_back(static_cast<int>(body));
  }
  const std::string& field(int body) const { return scene_.bodies[static_cast<std::size_t>(body)].field; }

  void describe_two(Slot& slot, bool materials, PairLawSpec& pair) const {
    std::size_t count = 2;
    slot.list(materials ? "a list of two materials" : "a list of two bodies", 2, 2, count,
              [&](Slot& item, std::size_t k) {
                if (item.reads() && !materials && states_unread(item.value()->node())) {
                  item.keep(false);  // reported where the body stands
                  return;
                }
                int& index = pair.between[k];
                if (item.reference(index, materials ? materials_ : names_) && item.reads() && !materials)
                  index = body_[static_cast<std::size_t>(index)];
              });
    if (slot.reads()) pair.materials = materials;
  }

  /// Also a level of a bitmap, NAME_LEVEL.
  bool states_unread(const Node& node) const {
    return std::any_of(unread_.begin(), unread_.end(), [&](const std::string& name) {
      return node.scalar == name || node.scalar.starts_with(name + "_");
    });
  }

  void check(Slot& who, const PairLawSpec& pair) const {
    if (pair.materials)
      check_mixed(who, pair);
    else if (field(pair.between[0]) == field(pair.between[1]))
      return who.report(fmt::format("the velocity field '{}' does not meet itself", field(pair.between[0])),
                        "A pair is of two bodies; two parts of one body that meet must be two bodies");
    check_twin(who, pair);
    check_columns(who, pair);
  }

  /// A field of several materials has no single one that a pair of materials could mean.
  void check_mixed(Slot& who, const PairLawSpec& pair) const {
    std::map<std::string, int> material;
    for (const BodySpec& body : scene_.bodies) {
      const auto [known, first] = material.emplace(body.field, body.material);
      if (first || known->second == body.material) continue;
      for (int one : pair.between)
        if (one == known->second || one == body.material)
          return who.report(fmt::format(
              "the velocity field '{}' holds several materials: name its bodies (between: …)", body.field));
    }
  }

  void check_twin(Slot& who, const PairLawSpec& pair) const {
    const auto key = [&](int k) {
      return pair.materials ? scene_.materials[static_cast<std::size_t>(k)].name : field(k);
    };
    for (const PairLawSpec& other : scene_.contact.pairs) {
      if (other.materials != pair.materials) continue;
      const auto same = [&](std::size_t i, std::size_t j) {
        return key(other.between[0]) == key(pair.between[i]) && key(other.between[1]) == key(pair.between[j]);
      };
      if (same(0, 1) || same(1, 0)) return who.report("this pair has a law already");
    }
  }

  /// history.csv calls a pair NAME+NAME. No other name has a '+'.
  void check_columns(Slot& who, const PairLawSpec& pair) const {
    const auto name = [&](const PairLawSpec& of, std::size_t k) {
      const auto index = static_cast<std::size_t>(of.between[k]);
      return of.materials ? scene_.materials[index].name : scene_.bodies[index].name;
    };
    for (const PairLawSpec& other : scene_.contact.pairs)
      if (other.materials != pair.materials && name(other, 0) == name(pair, 0) &&
          name(other, 1) == name(pair, 1))
        return who.report(
            fmt::format(
                "a pair of bodies and a pair of materials are both called '{}+{}': their forces would "
                "share a column",
                name(pair, 0), name(pair, 1)),
            "Name the two of this pair in the other order");
  }

  Scene& scene_;
  std::vector<std::string> materials_, unread_, names_;
  std::vector<int> body_;  ///< of each name
};

}  // namespace

void describe_pairs(Keys& contact, Keys& top, Scene& scene) {
  contact.at("pairs", "Pairs of bodies or of materials with a law of their own.", [&](Slot& slot) {
    std::size_t count = scene.contact.pairs.size();
    if (slot.writes() && count == 0) return;
    PairEntries entries(scene, unread_bodies(top, scene));
    slot.list("a list of maps {between: …, law: …}", 0, Form::kNoEnd, count, [&](Slot& entry, std::size_t k) {
      entries.describe(
          entry, entry.writes() ? scene.contact.pairs[k] : PairLawSpec{false, {0, 0}, scene.contact.law});
    });
  });
}

}  // namespace mpmfast
