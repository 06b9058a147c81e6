#include "engine/cracks/tip_contact.hpp"

#include <utility>

#include "engine/constants.hpp"
#include "kernels/fracture/tip_path.hpp"

namespace mpmfast {

namespace {

template <int Dim>
Vec<2> position_of(const GridView<Dim>& grid, const ContactNode<Dim>& node) {
  return {grid.origin[0] + node.index[0] * grid.cell, grid.origin[1] + node.index[1] * grid.cell};
}

/// Calls f(node, e) for all contact pairs e of the sides of a crack.
template <int Dim, class F>
void for_each_contact(const ContactList<Dim>& contacts, int crack, const F& f) {
  for (const ContactNode<Dim>& node : contacts.nodes)
    for (int e = node.pair_begin; e < node.pair_end; ++e)
      if (contacts.pairs.pair[e].crack == crack) f(node, e);
}

/// Mean displacement gradient of a field of a contact node: Σ m u_i,j / Σ m.
template <int Dim>
Mat<2> displacement_gradient(const State<Dim>& state, const ContactList<Dim>& contacts,
                             const ContactNode<Dim>& node, int k) {
  const int slot = contacts.fields[node.field_begin + k].slot;
  const double mass = state.nodes.column(Nodal::mass)[slot];
  if (!(mass > 0)) return Mat<2>::Zero();
  Mat<2> sum;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) sum(i, j) = state.nodes.column(Nodal::mass_slope, Dim * i + j)[slot];
  return sum / mass;
}

}  // namespace

template <int Dim>
std::optional<double> length_to_softening(const State<Dim>& state, const ContactList<Dim>& contacts,
                                          int crack, const TipLine& line, double distance) {
  std::optional<double> least;
  if (contacts.pairs.bond.empty()) return least;
  TipLine from_end = line;
  for (Vec<2>& x : from_end) x -= line.front();
  const TipPath path(std::move(from_end), distance, crack_constants::kSmoothing * state.grid.cell);
  for_each_contact(contacts, crack, [&](const ContactNode<Dim>& node, int e) {
    const Bond<Dim>& bond = contacts.pairs.bond[e];
    if (!(bond.damage > crack_constants::kDamageOnset) || bond.follows()) return;
    const TipPath::Projection on = path.project(position_of(state.grid, node) - line.front());
    if (!least || on.behind < *least) least = on.behind;
  });
  return least;
}

template <int Dim>
std::vector<TipTraction> side_tractions(const State<Dim>& state, const ContactList<Dim>& contacts, int crack,
                                        bool springs, double thickness, double dt, const Vec<2>& origin,
                                        const Mat<2>& axes) {
  std::vector<TipTraction> tractions;
  if (!state.nodes.has(Nodal::mass_slope)) return tractions;
  for_each_contact(contacts, crack, [&](const ContactNode<Dim>& node, int e) {
    const PairColumns<Dim>& pairs = contacts.pairs;
    const ContactPair& pair = pairs.pair[e];
    if (pair.is_lumped()) return;
    Vec<Dim> impulse = pairs.impulse[e].second;
    if (springs && !pairs.spring.empty()) impulse += pairs.spring[e].impulse;
    const Mat<2> jump = displacement_gradient(state, contacts, node, pair.a) -
                        displacement_gradient(state, contacts, node, pair.b);
    tractions.push_back({axes * (position_of(state.grid, node) - origin),
                         axes * impulse.template head<2>() / (dt * thickness),
                         axes * jump * axes.transpose()});
  });
  return tractions;
}

template std::optional<double> length_to_softening(const State<2>&, const ContactList<2>&, int,
                                                   const TipLine&, double);
template std::vector<TipTraction> side_tractions(const State<2>&, const ContactList<2>&, int, bool, double,
                                                 double, const Vec<2>&, const Mat<2>&);

}  // namespace mpmfast
