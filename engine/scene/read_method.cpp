#include <fmt/format.h>

#include <cctype>
#include <charconv>

#include "engine/scene/sections.hpp"
#include "engine/scene/suggest.hpp"

namespace mpmfast {

namespace {

constexpr int kLeastOrder = 2, kMostOrder = 20;

/// "XPIC 5" → "Did you mean 'xpic(5)'?": letters and digits tell, whatever stands between.
std::string meant_update(const std::string& text) {
  const std::vector<std::string> known{"flip", "pic", "apic", "xpic", "fmpm"};
  std::string letters, digits;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte)) letters += static_cast<char>(std::tolower(byte));
    if (std::isdigit(byte)) digits += c;
  }
  if ((letters == "xpic" || letters == "fmpm") && !digits.empty())
    return fmt::format("Did you mean '{}({})'?", letters, digits);
  return did_you_mean(letters, known);
}

/// flip, pic, apic, xpic(m) or fmpm(m).
void read_update(const Value& value, MethodSpec& method) {
  value.offers(kUpdates, kLeastOrder, kMostOrder);
  constexpr const char* kExpected = "not an update (flip, pic, apic, or xpic(m) or fmpm(m) with m = 2..20)";
  if (!value.is(Node::Kind::scalar)) return value.complain(kExpected);
  const std::string& text = value.node().scalar;
  method.xpic_order = 1;
  if (text == "flip") {
    method.update = UpdateKind::flip;
    return;
  }
  if (text == "pic") {
    method.update = UpdateKind::pic;
    return;
  }
  if (text == "apic") {
    if (method.basis != BasisKind::bspline2 && method.basis != BasisKind::bspline3)
      value.report(
          "apic needs basis: bspline2 or bspline3 (the second moment of its weights must be constant)");
    method.update = UpdateKind::apic;
    method.position = PositionKind::particle;
    return;
  }
  const std::string name = text.substr(0, text.find('('));
  if (name != "xpic" && name != "fmpm") return value.complain(kExpected, meant_update(text));
  int order = 0;
  const char* const first = text.data() + name.size() + 1;
  const bool closed = text.size() > name.size() + 2 && text.back() == ')';
  const char* const last = text.data() + text.size() - 1;
  const bool whole = closed && std::from_chars(first, last, order).ptr == last && *first != '0';
  if (!whole || order < kLeastOrder || order > kMostOrder) {
    return value.complain(name + " needs its order (" + name + "(m) with m = 2..20)",
                          order == 1 ? name + "(1) is pic" : "");
  }
  method.update = name == "xpic" ? UpdateKind::xpic : UpdateKind::fmpm;
  method.xpic_order = order;
}

}  // namespace

bool read_method(MapReader& top, MethodSpec& method) {
  const auto section = top.find("method");
  if (!section) return false;
  MapReader map(*section, "a map {basis, update, …}");
  map.word("basis", kBases, method.basis);
  map.otherwise("update", name_of(kUpdates, method.update));
  if (const auto update = map.find("update")) read_update(*update, method);
  constexpr int kMostBetween = 1000;
  map.integer("every", 1, kMostBetween, method.filter_every);
  if (method.filter_every > 1 && method.update != UpdateKind::xpic && method.update != UpdateKind::fmpm)
    map.find("every")->complain("every belongs to xpic(m) and fmpm(m), the others filter nothing");
  map.word("strain", kStrains, method.strain);
  const auto position = map.find("position");
  map.otherwise("position", name_of(kPositions, method.position));
  if (const auto chosen = position ? position->word(kPositions) : std::nullopt) {
    if (method.update == UpdateKind::flip && *chosen != PositionKind::grid &&
        *chosen != PositionKind::grid_end) {
      position->complain("flip moves particles with the grid (position: grid or grid_end)");
    }
    if (method.update == UpdateKind::apic && *chosen != PositionKind::particle) {
      position->complain("apic moves particles with their velocity (position: particle)");
    }
    method.position = *chosen;
  }
  map.boolean("contact_correction", method.contact_correction);
  map.boolean("own_filter", method.own_filter);
  // A gradient taken after the particles have moved is that at the end of their motion.
  if (method.strain == StrainKind::first) method.deformation_terms = MethodSpec::kInverse;
  map.word("deformation_terms", kDeformationTerms, method.deformation_terms);
  const bool strain_stated = map.find("strain").has_value();
  map.finish();
  return strain_stated;
}

}  // namespace mpmfast
