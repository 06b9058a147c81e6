#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <charconv>

#include "engine/scene/keys/basis_names.hpp"
#include "engine/scene/sections/describe.hpp"
#include "engine/scene/text/suggest.hpp"

namespace mpmfast {

namespace {

constexpr int kLeastOrder = 2, kMostOrder = 20;

bool filters(UpdateKind update) { return update == UpdateKind::xpic || update == UpdateKind::fmpm; }

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

/// The order of "xpic(m)"; 0 where there is none, or none as the reader wants it.
int order_of(const std::string& text, std::size_t name_size) {
  const bool closed = text.size() > name_size + 2 && text.back() == ')';
  const char* const first = text.data() + name_size + 1;
  const char* const last = text.data() + text.size() - 1;
  int order = 0;
  const bool whole = closed && std::from_chars(first, last, order).ptr == last && *first != '0';
  return whole ? order : 0;
}

void read_update(Slot& slot, MethodSpec& method) {
  constexpr const char* kExpected = "not an update (flip, pic, apic, or xpic(m) or fmpm(m) with m = 2..20)";
  const Value& value = *slot.value();
  if (!value.is(Node::Kind::scalar)) return slot.complain(kExpected);
  const std::string &text = value.node().scalar, name = text.substr(0, text.find('('));
  for (const Keyword<UpdateKind>& word : kUpdates) {
    const std::string known = word.name;
    if (text != known && (!filters(word.value) || name + "(m)" != known)) continue;
    method.update = word.value;
    method.xpic_order = 1;
    if (!filters(word.value)) return;
    const int order = order_of(text, name.size());
    if (order < kLeastOrder || order > kMostOrder)
      return slot.complain(name + " needs its order (" + name + "(m) with m = 2..20)",
                           order == 1 ? name + "(1) is pic" : "");
    method.xpic_order = order;
    return;
  }
  slot.complain(kExpected, meant_update(text));
}

/// flip, pic, apic, xpic(m) or fmpm(m).
void describe_update(Slot& slot, MethodSpec& method) {
  slot.offer({Form::Kind::word, Measure::number, kAny, kLeastOrder, kMostOrder});
  for (const Keyword<UpdateKind>& word : kUpdates) slot.offer(word.name, word.description);
  std::string name(name_of(kUpdates, method.update));
  if (filters(method.update)) name.replace(name.find("(m)"), 3, fmt::format("({})", method.xpic_order));
  slot.write(name);
  if (!slot.reads()) return;
  read_update(slot, method);
  if (!slot.good() || method.update != UpdateKind::apic || facts(method.basis).spread > 0) return;
  std::vector<std::string> good;
  for (const BasisFacts& basis : kBasisFacts)
    if (basis.spread > 0) good.emplace_back(basis.keyword);
  slot.report(fmt::format("apic needs basis: {} (the second moment of its weights must be constant)",
                          fmt::join(good, " or ")));
}

/// none or {occupation}.
void describe_extension(Slot& slot, MethodSpec& method) {
  constexpr Limit kShare{"in (0, 1)", 0, 1, true, true};
  if (slot.is_keyword("none", !method.extended)) return;
  slot.map("none or a map {occupation}", [&](Keys& map) {
    if (map.reads()) method.extended = true;
    map.key("occupation", "A cell has enough of a body that is filled to more than this share.",
            method.occupation, Number{Measure::number, kShare});
  });
  if (slot.reads() && method.extended && facts(method.basis).spread == 0)
    slot.report("splines alone are extended (basis: bspline2 or bspline3)");
}

/// none, false, true or {edge}.
void describe_split(Slot& slot, MethodSpec& method) {
  constexpr const char* kExpected = "none, true or a map {edge}";
  // Shorter than a cell, and particles would be split as they are seeded; domains of two are scaled down.
  constexpr Limit kEdge{"from 1 to 2 cells", 1, 2};
  if (slot.is_keyword("none", !method.split)) return;
  if (slot.describes()) slot.offer({Form::Kind::truth});
  if (slot.reads() && slot.value()->is(Node::Kind::scalar)) {
    method.split = slot.value()->is_keyword("true");
    if (!method.split && !slot.value()->is_keyword("false"))
      return slot.complain(std::string("not ") + kExpected, "Write {edge: 1.5}");
  } else {
    slot.map(kExpected, [&](Keys& map) {
      if (map.reads()) method.split = true;
      map.key("edge", "Edges of domains longer than this are halved, cells.", method.split_edge,
              Number{Measure::number, kEdge});
    });
  }
  if (!slot.reads() || !method.split || facts(method.basis).convected) return;
  std::vector<std::string> good;
  for (const BasisFacts& basis : kBasisFacts)
    if (basis.convected) good.emplace_back(basis.keyword);
  slot.report(fmt::format("only particles whose domains follow the deformation are split (basis: {})",
                          fmt::join(good, " or ")));
}

void check_position(Slot& slot, const MethodSpec& method) {
  const bool by_grid = method.position == PositionKind::grid || method.position == PositionKind::grid_end;
  if (method.update == UpdateKind::flip && !by_grid)
    slot.complain("flip moves particles with the grid (position: grid or grid_end)");
  if (method.update == UpdateKind::apic && method.position != PositionKind::particle)
    slot.complain("apic moves particles with their velocity (position: particle)");
}

}  // namespace

bool describe_method(Keys& top, MethodSpec& method) {
  bool strain_stated = false;
  top.section(
      "method", "How the grid and the particles exchange; the defaults suit most scenes.",
      "a map {basis, update, …}", [&](Keys& map) {
        constexpr int kMostBetween = 1000;
        map.key("basis", "Shape functions of the nodes.", method.basis, kBases);
        map.at("extension",
               "bspline2, bspline3: nodes with hardly any of a body near follow those that have enough.",
               [&](Slot& slot) { describe_extension(slot, method); });
        map.at("split",
               "lcpdi, qcpdi: a particle whose domain has become too long is split in two, so that the body "
               "stays whole; true: {edge: 1.5}.",
               [&](Slot& slot) { describe_split(slot, method); });
        map.at("update", "How particles take their velocity from the grid.",
               [&](Slot& slot) { describe_update(slot, method); });
        map.at("every", "xpic and fmpm: they filter every n-th step, and flip updates those between.",
               [&](Slot& slot) {
                 slot.take(method.filter_every, Whole{1, kMostBetween});
                 if (method.filter_every > 1 && !filters(method.update))
                   slot.complain("every belongs to xpic(m) and fmpm(m), the others filter nothing");
               });
        map.key("strain",
                "When within a step the strain of the particles is updated; `average` by default where "
                "contact is as published.",
                method.strain, kStrains);
        strain_stated = map.stated("strain").has_value();
        if (!map.writes() && method.update == UpdateKind::apic) method.position = PositionKind::particle;
        map.at("position", "Which velocity moves the particles; `particle` with the update apic.",
               [&](Slot& slot) {
                 if (slot.take(method.position, kPositions)) check_position(slot, method);
               });
        map.key("contact_correction",
                "xpic: its filter knows of the changes that contact makes (N20 Eq. 42).",
                method.contact_correction);
        map.key("own_filter",
                "xpic: filter the velocities from before the first contact correction; saves half of its "
                "passes.",
                method.own_filter);
        // A gradient taken after the particles have moved is that at the end of their motion.
        if (!map.writes() && method.strain == StrainKind::first)
          method.deformation_terms = MethodSpec::kInverse;
        map.key("deformation_terms",
                "How the deformation gradient follows the velocity gradient; `inverse` with strain: first.",
                method.deformation_terms, kDeformationTerms);
      });
  return strain_stated;
}

}  // namespace mpmfast
