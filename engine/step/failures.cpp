/// How a step fails: which particle is to blame, where it is, and why.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/constants.hpp"
#include "engine/errors.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

namespace {

template <int Dim>
bool is_finite(const Particles<Dim>& particles, std::size_t p) {
  for (const Quantity q : particles.quantities())
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      if (!std::isfinite(particles.column(q, k)[p])) return false;
  return true;
}

/// What is not a number any more, for a message.
template <int Dim>
std::string not_finite(const Particles<Dim>& particles, std::size_t p) {
  std::string names;
  for (const Quantity q : particles.quantities()) {
    bool finite = true;
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      finite &= std::isfinite(particles.column(q, k)[p]);
    if (!finite)
      names +=
          fmt::format("{}{}", names.empty() ? "" : ", ", kQuantityTable[static_cast<std::size_t>(q)].name);
  }
  return names;
}

/// Nothing where the scene has said so.
const char* other_ways_to_leave(const GridSpec& grid) {
  return grid.outflow == OutflowKind::stop ? " (grid.leaving says what else may become of it)" : "";
}

/// The particle of the least value, of equal ones that with the smallest id; `none` where no value is below
/// `bound`.
template <int Dim, class Value>
std::size_t least(const Particles<Dim>& particles, double bound, const Value& value) {
  std::size_t found = particles.size();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = value(p);
    if (!(x < bound || (found < particles.size() && x == bound && particles.id()[p] < particles.id()[found])))
      continue;
    found = p;
    bound = x;
  }
  return found;
}

}  // namespace

template <int Dim>
Vec<Dim> Step<Dim>::position_of(std::size_t p) const {
  const Vec<Dim> x = state_.particles.vector(Quantity::position, p);
  if (x.allFinite()) return x;
  Vec<Dim> position;
  const NodeIndex<Dim> node = state_.tiling.sorted_node(p);
  // Supports of 2 to 5 nodes: the particle is about a cell and a half above the first.
  for (int d = 0; d < Dim; ++d) position[d] = state_.grid.origin[d] + (node[d] + 1.5) * state_.grid.cell;
  return position;
}

/// A number that is none spreads over a support in a step: the particle in the middle of those that are hit
/// comes nearest to the one where it began.
template <int Dim>
void Step<Dim>::fail(const char* otherwise) const {
  const auto& particles = state_.particles;
  const std::size_t none = particles.size();
  constexpr double kNever = std::numeric_limits<double>::infinity();
  Vec<Dim> middle = Vec<Dim>::Zero();
  std::vector<bool> broken(particles.size());
  std::size_t count = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (is_finite(particles, p)) continue;
    broken[p] = true;
    middle += position_of(p);
    ++count;
  }
  if (count > 0) {
    middle /= static_cast<double>(count);
    std::size_t p = least(particles, kNever, [&](std::size_t q) {
      return broken[q] ? (position_of(q) - middle).norm() : kNever;
    });
    if (p == none)  // they are too far apart for a distance
      p = static_cast<std::size_t>(std::find(broken.begin(), broken.end(), true) - broken.begin());
    std::string cause = fmt::format("not a number any more ({})", not_finite(particles, p));
    if (count == 2) cause += ", nor is one particle around it";
    if (count > 2) cause += fmt::format(", nor are {} particles around it", count - 1);
    fail_at(p, cause);
  }
  const auto volume = [&](std::size_t p) {
    return !state_.bodies[particles.body()[p]].rigid ? particles.volume_ratio(p) : 1.0;
  };
  if (const std::size_t p = least(particles, std::numeric_limits<double>::min(), volume); p != none)
    fail_at(p, fmt::format("its volume became zero or negative (J = {:.3g})", volume(p)));
  const auto id_outside = [&](std::size_t p) {
    const Vec<Dim> x = particles.vector(Quantity::position, p);
    const bool inside = (x.array() > lower_.array()).all() && (x.array() < upper_.array()).all();
    return inside ? kNever : static_cast<double>(particles.id()[p]);
  };
  if (const std::size_t p = least(particles, kNever, id_outside); p != none)
    fail_at(p, fmt::format("it left the grid at {:.4g} m/s{}", particles.vector(Quantity::velocity, p).norm(),
                           other_ways_to_leave(scene_->grid)));
  if (!particles.has(Quantity::domain_edges) || particles.size() == 0)
    throw RunFailure(fmt::format("step {}, time {:.9g} s: {}", state_.step, state_.time, otherwise));
  const std::size_t widest = least(particles, kNever, [&](std::size_t p) {
    double squared = 0;
    for (int e = 0; e < Dim * Dim; ++e) {
      const double edge = particles.column(Quantity::domain_edges, e)[p];
      squared += edge * edge;
    }
    return -std::min(squared, std::numeric_limits<double>::max());
  });
  fail_at(widest, fmt::format("{}; of all domains its own is the largest", otherwise));
}

/// A step that is no number has no size: some particle's speed or place is to blame.
template <int Dim>
void Step<Dim>::fail_collapsed(double dt, double share) const {
  if (!std::isfinite(dt)) fail("a speed is no number any more");
  const auto& particles = state_.particles;
  const auto speed = [&](std::size_t p) { return particles.vector(Quantity::velocity, p).norm(); };
  const double* wave_speed = particles.column(Quantity::wave_speed);
  const std::string what =
      share < 1 ? fmt::format("the time step collapsed to {:.3g} s, {:.2g} of the first", dt, share)
                : fmt::format("steps of {:.3g} s never reach the end", dt);
  const std::size_t p = least(particles, std::numeric_limits<double>::infinity(),
                              [&](std::size_t q) { return -(wave_speed[q] + speed(q)); });
  if (p == particles.size())
    throw RunFailure(fmt::format("step {}, time {:.9g} s: {}", state_.step, state_.time, what));
  fail_at(p, fmt::format("{}{}: its waves run at {:.4g} m/s, it moves at {:.4g} m/s, J = {:.3g}", what,
                         share < 1 ? " (time.collapse)" : "", wave_speed[p], speed(p),
                         particles.volume_ratio(p)));
}

template <int Dim>
void Step<Dim>::fail_folded(const Fold& fold) const {
  const auto& particles = state_.particles;
  std::size_t p = 0;
  while (particles.id()[p] != fold.id) ++p;
  fail_at(p, "the surface folds onto itself there");
}

/// The coldest particle, where each temperature is a number.
template <int Dim>
void Step<Dim>::fail_warmed() const {
  const auto& particles = state_.particles;
  const double* temperature = particles.column(Quantity::temperature);
  const std::size_t p = least(particles, constants::step::kLeastTemperature, [&](std::size_t q) {
    return std::isfinite(temperature[q]) ? temperature[q] : std::numeric_limits<double>::infinity();
  });
  if (p == particles.size()) fail("a temperature is no number");
  fail_at(p, fmt::format("its temperature fell to {:.3g} K", temperature[p]));
}

template <int Dim>
void Step<Dim>::fail_at(std::size_t particle, const std::string& cause) const {
  const auto& particles = state_.particles;
  const Vec<Dim> x = position_of(particle);
  const bool known = particles.vector(Quantity::position, particle).allFinite();
  RunFailure::Position position{};
  std::string text;
  for (int d = 0; d < Dim; ++d) {
    position[static_cast<std::size_t>(d)] = x[d];
    text += fmt::format("{}{:.6g}", d > 0 ? ", " : "", x[d]);
  }
  const auto body = static_cast<std::size_t>(particles.body()[particle]);
  const auto field = static_cast<std::size_t>(plan_.body_field[body]);
  throw RunFailure(
      fmt::format("step {}, time {:.9g} s: particle {} of body '{}' (velocity field '{}') {} ({}) m: {}",
                  state_.step, state_.time, particles.id()[particle], scene_->bodies[body].name,
                  plan_.fields[field], known ? "at" : "near", text, cause),
      position);
}

// Here: the members that this file defines.
template Vec<2> Step<2>::position_of(std::size_t) const;
template Vec<3> Step<3>::position_of(std::size_t) const;
template void Step<2>::fail(const char*) const;
template void Step<3>::fail(const char*) const;
template void Step<2>::fail_warmed() const;
template void Step<3>::fail_warmed() const;
template void Step<2>::fail_folded(const Fold&) const;
template void Step<3>::fail_folded(const Fold&) const;
template void Step<2>::fail_at(std::size_t, const std::string&) const;
template void Step<3>::fail_at(std::size_t, const std::string&) const;
template void Step<2>::fail_collapsed(double, double) const;
template void Step<3>::fail_collapsed(double, double) const;

}  // namespace mpmfast
