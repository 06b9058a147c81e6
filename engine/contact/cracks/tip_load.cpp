#include "engine/contact/cracks/tip_load.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "engine/plan/seed.hpp"
#include "kernels/fracture/tip_integrals.hpp"
#include "kernels/materials/at_rest.hpp"

namespace mpmfast {

namespace {

constexpr double kBack = 2;       // cells that the direction of an end is looked for along
constexpr double kBlur = 0.75;    // cells
constexpr double kOutline = 1.5;  // cells, within which an end is at the outline
constexpr double kApart = 0.8;    // of the way to the other end that a disk may take
constexpr double kWorn = 0.02;    // share of its way to broken from which on a bond softens

/// The points of a crack from one of its ends on, until that far.
template <int Dim>
std::vector<Vec<2>> points_behind(const CrackLine<Dim>& line, bool end, double far) {
  const auto& points = line.points;
  std::vector<Vec<2>> out;
  for (std::size_t k = 0; k < points.size(); ++k) {
    out.push_back(points[end ? points.size() - 1 - k : k].template head<2>());
    if (out.size() > 1 && (out.back() - out.front()).norm() > far) break;
  }
  return out;
}

/// Out of a crack: from a point some cells behind its end, but not from beyond where it turned last.
Vec<2> direction(const std::vector<Vec<2>>& points, double cell, double straight) {
  const double most = std::min(kBack * cell, straight);
  std::size_t back = 1;
  while (back + 1 < points.size() && (points[0] - points[back]).norm() < most * (1 - 1e-6)) ++back;
  return (points[0] - points[back]).normalized();
}

/// What the grid says at a particle, between the nodes of its cell.
template <int Dim>
struct GridReader {
  const State<Dim>* state;
  const ParticleTile<Dim>* tile;

  int slot(const NodeIndex<Dim>& node) const {
    int corner = 0, local = 0, at = 0;
    for (int d = Dim - 1; d >= 0; --d) {
      const int w = node[d] - tile->window[d];
      if (w < 0 || w >= kWindowSide) return -1;
      corner = 2 * corner + w / kTileSide;
      local = kTileSide * local + w % kTileSide;
      at = kWindowSide * at + w;
    }
    if (tile->node_slot) return tile->node_slot[at];
    return tile->slot[corner] < 0 ? -1 : tile->slot[corner] + local;
  }

  /// Where a node has no mass, as of a cell that the particle came to in the step, it moves with the particle
  /// and is as fast driven as the others.
  void read(const Vec<Dim>& x, double dt, TipSample& out) const {
    NodeIndex<Dim> low;
    Vec<Dim> share;
    double seen = 0;
    for (int d = 0; d < Dim; ++d) {
      const double cells = (x[d] - state->grid.origin[d]) * state->grid.inverse_cell;
      low[d] = node_at(std::floor(cells));
      share[d] = cells - low[d];
    }
    for (int corner = 0; corner < kCorners<Dim>; ++corner) {
      NodeIndex<Dim> node = low;
      double weight = 1;
      Vec<2> slope = Vec<2>::Constant(state->grid.inverse_cell);
      for (int d = 0; d < Dim; ++d) {
        const bool up = corner >> d & 1;
        node[d] += up;
        weight *= up ? share[d] : 1 - share[d];
        for (int e = 0; e < 2; ++e) slope[e] *= e == d ? (up ? 1 : -1) : up ? share[d] : 1 - share[d];
      }
      const int at = slot(node);
      if (at < 0 || !(state->nodes.column(Nodal::mass)[at] > 0)) continue;
      const Vec<2> velocity = state->nodes.vector(Nodal::velocity, at).template head<2>();
      seen += weight;
      out.acceleration += weight / dt * state->nodes.vector(Nodal::force, at).template head<2>();
      out.velocity_slope += (velocity - out.velocity) * slope.transpose();
    }
    if (seen > 0) out.acceleration /= seen;
  }
};

template <int Dim>
TipSample sample_of(State<Dim>& state, std::size_t p, double thickness) {
  const auto& particles = state.particles;
  Mat<2> start = Mat<2>::Identity();
  if (particles.has(Quantity::initial_deformation))
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        start(i, j) = particles.column(Quantity::initial_deformation, Dim * i + j)[p];
  TipSample out;
  out.slope =
      Mat<2>::Identity() - start * particles.deformation_gradient(p).template topLeftCorner<2, 2>().inverse();
  const double ratio = particles.volume_ratio(p),
               volume = ratio * particles.column(Quantity::initial_volume)[p];
  const auto stress = [&](int k) { return particles.column(Quantity::kirchhoff_stress, k)[p] / ratio; };
  out.stress << stress(0), stress(3), stress(3), stress(1);
  out.moved = Vec<2>::Zero();
  if (particles.has(Quantity::reference_position))
    out.moved = (particles.vector(Quantity::position, p) - particles.vector(Quantity::reference_position, p))
                    .template head<2>();
  out.velocity = particles.vector(Quantity::velocity, p).template head<2>();
  out.area = volume / thickness;
  out.energy = inner_energy(state, p) / volume;
  out.density = particles.column(Quantity::mass)[p] / volume;
  return out;
}

template <int Dim>
Vec<2> place_of(const State<Dim>& state, const ContactNode<Dim>& node) {
  return {state.grid.origin[0] + node.index[0] * state.grid.cell,
          state.grid.origin[1] + node.index[1] * state.grid.cell};
}

/// E′ of the body of a field, Pa.
template <int Dim>
double modulus_of(const State<Dim>& state, int field) {
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    if (state.body_field[b] == field && !state.bodies[b].rigid)
      return std::visit([&](const auto& law) { return plane_modulus(law, state.depth == Depth::relaxed); },
                        state.materials[static_cast<std::size_t>(state.bodies[b].material)]);
  return 0;
}

/// How far a body goes on ahead of a tip: so far that what lies ahead is covered, m; 0: it ends at the tip.
double covered_radius(const TipSamples& samples, double radius, double cell) {
  constexpr double kWedge = 0.5, kCovered = 0.8, kThrough = 0.4;  // of its width to its length; of its area
  const double strip = 0.5 * cell;
  const auto half_width = [&](double x) { return std::max(cell, kWedge * x); };
  const auto strips = std::max(std::size_t{4}, static_cast<std::size_t>(radius / strip));
  std::vector<double> area(strips, 0.0);
  for (const TipSample& one : samples)
    if (one.place[0] >= 0 && std::abs(one.place[1]) < half_width(one.place[0]))
      if (const auto k = static_cast<std::size_t>(one.place[0] / strip); k < strips) area[k] += one.area;
  double sum = 0, whole = 0, covered = 0;
  for (std::size_t k = 0; k < strips; ++k) {
    const double x = strip * static_cast<double>(k + 1);
    sum += area[k];
    whole += 2 * strip * half_width(x - 0.5 * strip);
    if (k < 3) continue;  // of two cells
    if (k == 3 && sum < kThrough * whole) return 0;
    if (k == 3 || sum >= kCovered * whole) covered = x;
  }
  return covered;
}

/// So far behind is the foremost bond that softens, m; nothing where none does.
template <int Dim>
std::optional<double> foremost_worn(const State<Dim>& state, const ContactList<Dim>& contacts, int crack,
                                    const std::vector<Vec<2>>& points, double far) {
  std::optional<double> least;
  if (contacts.pairs.bond.empty()) return least;
  std::vector<Vec<2>> from_end = points;
  for (Vec<2>& x : from_end) x -= points.front();
  const TipPath path(std::move(from_end), far, kBlur * state.grid.cell);
  for (const ContactNode<Dim>& node : contacts.nodes)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const Bond<Dim>& bond = contacts.pairs.bond[e];
      if (contacts.pairs.pair[e].crack != crack || !(bond.damage > kWorn) || bond.follows()) continue;
      const TipPath::Beside at = path.beside(place_of(state, node) - points.front());
      if (!least || at.behind < *least) least = at.behind;
    }
  return least;
}

/// Cuts what is ahead of a place off the points behind an end.
void cut(std::vector<Vec<2>>& points, double behind) {
  while (points.size() > 2) {
    const double piece = (points[0] - points[1]).norm();
    if (piece > behind) break;
    behind -= piece;
    points.erase(points.begin());
  }
  points[0] += behind * (points[1] - points[0]).normalized();
}

/// What the material carries across the last straight part of a crack: along it and across.
Vec<2> across_end(const TipSamples& samples, const std::vector<Vec<2>>& points, const Vec<2>& ahead,
                  double straight, double cell) {
  constexpr double kBeside = 1;  // cells
  Vec<2> sum = Vec<2>::Zero();
  double area = 0;
  for (const TipSample& one : samples) {
    const Vec<2> from = one.place - points.front();
    const double behind = -from.dot(ahead), beside = ahead[0] * from[1] - ahead[1] * from[0];
    if (behind < 0 || behind > std::min(straight, kBack * cell) || std::abs(beside) > kBeside * cell)
      continue;
    const Vec<2> traction = one.stress * Vec<2>(-ahead[1], ahead[0]);
    area += one.area;
    sum += one.area * Vec<2>(traction.dot(ahead), ahead[0] * traction[1] - ahead[1] * traction[0]);
  }
  return area > 0 ? Vec<2>(sum / area) : sum;
}

/// What is within a distance of a place, in the axes of the scene.
template <int Dim>
void list_samples(State<Dim>& state, int field, const TipQuestion& question, const Vec<2>& about,
                  double radius, TipSamples& samples) {
  samples.clear();
  for (const ParticleTile<Dim>& tile : state.tiling.tiles) {
    if (tile.field != field) continue;
    bool near = true;
    for (int d = 0; d < 2; ++d) {
      const double low = state.grid.origin[d] + tile.window[d] * state.grid.cell;
      near &= low - radius < about[d] && about[d] < low + kWindowSide * state.grid.cell + radius;
    }
    if (!near) continue;
    const GridReader<Dim> grid{&state, &tile};
    for (int r = tile.run_begin; r < tile.run_end; ++r) {
      const auto& run = state.tiling.runs[static_cast<std::size_t>(r)];
      for (std::size_t p = run.begin; p < run.end; ++p) {
        const Vec<Dim> x = state.particles.vector(Quantity::position, p);
        if ((x.template head<2>() - about).squaredNorm() >= radius * radius) continue;
        TipSample one = sample_of(state, p, question.thickness);
        grid.read(x, question.dt, one);
        one.place = x.template head<2>();
        one.acceleration -= question.fall;
        samples.push_back(one);
      }
    }
  }
}

/// J is the same for whoever flies along with the body; its sums over particles are not: the terms of a
/// velocity that all share cancel in integrals alone.
void fly_along(TipSamples& samples) {
  Vec<2> sum = Vec<2>::Zero();
  double area = 0;
  for (const TipSample& one : samples) {
    sum += one.area * one.velocity;
    area += one.area;
  }
  for (TipSample& one : samples) one.velocity -= sum / area;
}

/// The forces that contact lets a crack carry across. Those of bonds that soften are left out: of these J is
/// the energy.
template <int Dim>
void add_tractions(const State<Dim>& state, const ContactList<Dim>& contacts, const TipQuestion& question,
                   const Vec<2>& about, const Mat<2>& axes, TipIntegrals& integrals) {
  if (!state.nodes.has(Nodal::mass_slope)) return;
  for (const ContactNode<Dim>& node : contacts.nodes)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = contacts.pairs.pair[e];
      if (pair.crack != question.crack || pair.is_lumped()) continue;
      const auto slope = [&](int k) {
        const int slot = contacts.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
        const double mass = state.nodes.column(Nodal::mass)[slot];
        Mat<2> sum;
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) sum(i, j) = state.nodes.column(Nodal::mass_slope, Dim * i + j)[slot];
        return Mat<2>(mass > 0 ? Mat<2>(sum / mass) : Mat<2>::Zero());
      };
      Vec<Dim> impulse = contacts.pairs.impulse[e].second;
      if (!question.bonded && !contacts.pairs.spring.empty()) impulse += contacts.pairs.spring[e].impulse;
      integrals.add(TipTraction{axes * (place_of(state, node) - about),
                                axes * impulse.template head<2>() / (question.dt * question.thickness),
                                axes * (slope(pair.a) - slope(pair.b)) * axes.transpose()});
    }
}

}  // namespace

template <int Dim>
TipLoad tip_load(State<Dim>& state, const ContactList<Dim>& contacts, const CrackLine<Dim>& line,
                 const TipQuestion& question, TipSamples& samples) {
  const double cell = state.grid.cell,
               apart = (line.points.front() - line.points.back()).norm(),  // the other end has its own J
      radius = std::max(2 * cell, std::min(question.radius, kApart * apart));
  const CrackEnd& end = line.ends[question.end];
  const double far = std::max(2 * radius, 8 * cell);  // farther than a line leads its bonds
  std::vector<Vec<2>> behind = points_behind(line, question.end, 2 * far);
  TipLoad load;
  load.ahead = direction(behind, cell, end.straight);
  Vec<2> ahead = load.ahead;
  const std::vector<Vec<2>> to_end = behind;
  if (end.grows && end.grown > 0) {
    const std::optional<double> worn = foremost_worn(state, contacts, question.crack, behind, far);
    load.lead = std::min(worn.value_or(HUGE_VAL), end.grown);
    cut(behind, load.lead);
    if (load.lead > 0) {
      std::vector<Vec<2>> before = to_end;
      cut(before, std::max(0.0, load.lead - kBack * cell));
      ahead = before.front() == behind.front() ? load.ahead : (before.front() - behind.front()).normalized();
    }
  }
  load.place = behind.front();
  const double beyond = load.lead + kOutline * cell;  // so far ahead the body must go on
  const double asked = std::max(radius, beyond + cell);
  list_samples(state, line.field, question, load.place, asked, samples);
  if (samples.empty()) {
    load.through = true;
    return load;
  }
  fly_along(samples);
  load.modulus = modulus_of(state, line.field);
  load.across = across_end(samples, to_end, load.ahead, end.straight, cell);
  Mat<2> axes;  // rows
  axes << ahead[0], ahead[1], -ahead[1], ahead[0];
  for (Vec<2>& x : behind) x = axes * (x - load.place);
  for (TipSample& one : samples) {
    one.place = axes * (one.place - load.place);
    for (Vec<2>* v : {&one.moved, &one.velocity, &one.acceleration}) *v = axes * *v;
    for (Mat<2>* m : {&one.slope, &one.stress, &one.velocity_slope}) *m = axes * *m * axes.transpose();
  }
  const double covered = covered_radius(samples, asked, cell);
  load.through = covered < beyond;
  if (covered == 0) return load;
  const double within = std::min(radius, covered);
  const TipPath path(std::move(behind), within, kBlur * cell);
  TipIntegrals integrals(path, within, load.modulus, std::max(end.straight - load.lead, kOutline * cell),
                         cell);
  for (const TipSample& one : samples) integrals.add(one);
  add_tractions(state, contacts, question, load.place, axes, integrals);
  load.release = integrals.release();
  load.sliding = integrals.intensities()[0];
  load.opening = integrals.intensities()[1];
  return load;
}

template TipLoad tip_load(State<2>&, const ContactList<2>&, const CrackLine<2>&, const TipQuestion&,
                          TipSamples&);

}  // namespace mpmfast
