/// Forces between surfaces, and what they do.

#include "engine/contact/penalty/penalty.hpp"

#include <omp.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "engine/state/team.hpp"

namespace mpmfast {

namespace {

template <int Dim>
auto moment(const Vec<Dim>& arm, const Vec<Dim>& force) {
  if constexpr (Dim == 2)
    return arm[0] * force[1] - arm[1] * force[0];
  else
    return Vec<3>(arm.cross(force));
}

}  // namespace

template <int Dim>
Penalty<Dim>::Penalty(const Scene& scene, const Plan& plan, const State<Dim>& seeded)
    : active_(plan.penalty),
      surfaces_(&seeded.surfaces),
      spec_(scene.contact.springs),
      cell_(scene.grid.cell) {
  if (!active_) return;
  body_field_ = plan.body_field;
  pairs_ = plan.pairs;
  laws_.push_back(scene.contact.law.acts);
  for (const PairLawSpec& pair : scene.contact.pairs) laws_.push_back(pair.law.acts);
  modulus_.assign(scene.bodies.size(), 0);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    body_rigid_.push_back(is_rigid(scene, scene.bodies[b]));
  const auto& particles = seeded.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::size_t b = particles.body()[p];
    const double c = particles.column(Quantity::wave_speed)[p];
    const double density = density_of(scene.materials[static_cast<std::size_t>(scene.bodies[b].material)]);
    if (!body_rigid_[b]) modulus_[b] = std::max(modulus_[b], density * c * c);
  }
  const std::size_t n = surfaces_->points();
  now_.assign(n, Vec<Dim>::Zero());
  before_ = force_ = now_;
  holds_.resize(kPoints * surfaces_->facets.size());
  ball_.resize(surfaces_->facets.size());
  wedge_normal_.assign(surfaces_->wedges.size(), Vec<Dim>::Zero());
  rooms_.resize(static_cast<std::size_t>(omp_get_max_threads()));
}

template <int Dim>
double Penalty<Dim>::stiffness_between(int body_a, int body_b) const {
  const double a = modulus_[static_cast<std::size_t>(body_a)], b = modulus_[static_cast<std::size_t>(body_b)];
  const double softer = a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
  return spec_.stiffness * softer / cell_;
}

template <int Dim>
const AnyLaw& Penalty<Dim>::law_between(int field_a, int field_b) const {
  return laws_[pairs_.empty() ? 0 : static_cast<std::size_t>(pairs_.pair[pairs_.at(field_a, field_b)] + 1)];
}

namespace {

/// The most that holds a surface that is pressed by `normal`, N. @param speed  of the slip, m/s
struct Carried {
  double normal, speed;
  bool slides;

  double operator()(const Coulomb& law) const {
    return (slides ? law.friction : std::max(law.friction, law.static_friction)) * normal;
  }
  double operator()(const VelocityFriction& law) const {
    const double at_rest = std::max(law.friction, law.static_friction);
    return (law.friction + (at_rest - law.friction) * std::exp(-speed / law.decay_speed)) * normal;
  }
  double operator()(const Frictionless&) const { return 0; }
  double operator()(const Stick&) const { return kSticks; }
  template <class Other>
  double operator()(const Other&) const {
    return 0;
  }
};

}  // namespace

/// The force along the surface on the point: of a spring that stretches with the slip, up to what the law
/// carries (K24 Eq. 29, 32); of a film, of the slip's speed.
template <int Dim>
Vec<Dim> Penalty<Dim>::friction_force(const Touch& touch, Hold& hold, double elapsed, Pushed& pushed) const {
  const auto& other = facet(touch.facet);
  const int body = facet(touch.own).body;
  const AnyLaw& law = law_between(field_of(body), field_of(other.body));
  const auto along = [&](const Vec<Dim>& v) { return Vec<Dim>(v - v.dot(touch.exit) * touch.exit); };
  Vec<Dim> slip = mean(touch.own, touch.at, now_) - mean(touch.own, touch.at, before_);
  for (std::size_t k = 0; k < Dim; ++k)
    slip -= touch.share[k] * (at(other.point[k]) - before_[static_cast<std::size_t>(other.point[k])]);
  slip = along(slip);
  const double speed = elapsed > 0 ? slip.norm() / elapsed : 0;
  if (const auto* film = std::get_if<Viscous>(&law)) {
    if (!(elapsed > 0)) return Vec<Dim>::Zero();
    const double area = touch.stiffness / (0.5 * stiffness_between(body, other.body));
    const Vec<Dim> force = -0.5 * film->viscosity / film->film * area / elapsed * slip;
    pushed.lost = -force.dot(slip);
    return force;
  }
  const double stiffness = spec_.tangential * touch.stiffness;
  if (hold.piece != other.piece) {
    hold = {other.piece, false, Vec<Dim>::Zero()};
  } else {
    // The spring turns with the surface.
    const double length = hold.stretch.norm();
    Vec<Dim> turned = along(hold.stretch);
    const double left = turned.norm();
    if (left > 0) turned *= length / left;
    hold.stretch = turned + slip;
  }
  const double needed = stiffness * hold.stretch.norm();
  const double limit = std::visit(Carried{touch.stiffness * touch.depth, speed, hold.slides}, law);
  hold.slides = needed > limit;
  if (hold.slides) {
    const Vec<Dim> held = limit / needed * hold.stretch;
    pushed.lost = (hold.stretch - held).norm() * limit;
    hold.stretch = held;
  }
  pushed.stored = 0.5 * stiffness * hold.stretch.squaredNorm();
  return -stiffness * hold.stretch;
}

/// Forces along the way out on the corners of the facet, with the moment that `force` has about the foot.
template <int Dim>
void Penalty<Dim>::add_couple(const Touch& touch, const Vec<Dim>& force, Vec<Dim> (&back)[Dim]) const {
  const auto& corner = facet(touch.facet).point;
  const auto wanted = moment<Dim>(touch.to_foot, force);
  std::array<decltype(moment<Dim>(force, force)), Dim - 1>
      arm;  // of a unit force on the k-th and back on the first
  for (std::size_t k = 1; k < Dim; ++k) arm[k - 1] = moment<Dim>(at(corner[k]) - at(corner[0]), touch.exit);
  std::array<double, Dim - 1> size;
  if constexpr (Dim == 2) {
    size[0] = wanted / arm[0];
  } else {
    const double aa = arm[0].squaredNorm(), bb = arm[1].squaredNorm(), ab = arm[0].dot(arm[1]),
                 a = wanted.dot(arm[0]), b = wanted.dot(arm[1]), whole = aa * bb - ab * ab;
    size = {(a * bb - b * ab) / whole, (b * aa - a * ab) / whole};
  }
  for (std::size_t k = 1; k < Dim; ++k) {
    back[k] += size[k - 1] * touch.exit;
    back[0] -= size[k - 1] * touch.exit;
  }
}

/// K24 Eq. 31, 33 to 35, of a room's touches. Those of a point follow each other.
template <int Dim>
void Penalty<Dim>::push_out(const State<Dim>& state, double elapsed, Room& room) {
  room.pushed.clear();
  room.pressed = 0;
  int last = -1;
  std::size_t holds = 0;
  Holds known, held;
  const auto keep = [&] {
    if (last >= 0) holds_[static_cast<std::size_t>(last)] = held;
  };
  for (const Touch& touch : room.touches) {
    const int place = kPoints * touch.own + touch.at;
    if (place != last) {
      keep();
      last = place;
      known = holds_[static_cast<std::size_t>(place)];
      held = {state.step, {}};
      holds = 0;
      ++room.pressed;
    }
    Hold hold;
    if (known.step + 1 == state.step)  // else it touched nothing in the last step
      for (const Hold& one : known.of)
        if (one.piece == facet(touch.facet).piece) hold = one;
    Pushed pushed{};
    pushed.force = touch.stiffness * touch.depth * touch.exit + friction_force(touch, hold, elapsed, pushed);
    if (holds < kHolds) held.of[holds++] = hold;
    for (int k = 0; k < Dim; ++k) pushed.back[k] = -touch.share[k] * pushed.force;
    // Friction acts at the foot, not at the point: normal forces on the facet take the couple.
    add_couple(touch, pushed.force, pushed.back);
    room.pushed.push_back(pushed);
  }
  keep();
}

template <int Dim>
void Penalty<Dim>::press(const State<Dim>& state, const std::vector<Vec<Dim>>& pivots, double dt) {
  books_.reset(pivots.size(), laws_.size() - 1);
  std::fill(force_.begin(), force_.end(), Vec<Dim>::Zero());
  const double elapsed = known_ ? state.time - time_before_ : 0;
  if (!known_) before_ = now_;
  stretch_energy_ = 0;
  pressed_ = 0;
  const auto rooms = static_cast<std::int64_t>(rooms_.size());
  share_out(rooms, state.threads, 1,
            [&](std::int64_t r) { push_out(state, elapsed, rooms_[static_cast<std::size_t>(r)]); });
  // All in their order, whoever found them.
  for (const Room& room : rooms_) {
    pressed_ += room.pressed;
    for (std::size_t t = 0; t < room.touches.size(); ++t) {
      const Touch& touch = room.touches[t];
      const Pushed& pushed = room.pushed[t];
      for (int k = 0; k < Dim; ++k) {
        const auto corner = static_cast<std::size_t>(k);
        force_[static_cast<std::size_t>(facet(touch.own).point[corner])] +=
            corner_share(touch.at, k) * pushed.force;
        force_[static_cast<std::size_t>(facet(touch.facet).point[corner])] += pushed.back[k];
      }
      stretch_energy_ += pushed.stored;
      book(touch, pushed, dt);
    }
  }
  pressed_peak_ = std::max<std::uint64_t>(pressed_peak_, pressed_);
  for (std::size_t b = 0; b < body_rigid_.size(); ++b) {
    if (!body_rigid_[b]) continue;
    const auto& own = surfaces_->bodies[b];
    for (int p = own.first; p < own.first + own.count; ++p)
      book_rigid(p, force_[static_cast<std::size_t>(p)], pivots, dt);
  }
  before_ = now_;
  time_before_ = state.time;
  known_ = true;
}

template <int Dim>
void Penalty<Dim>::book(const Touch& touch, const Pushed& pushed, double dt) {
  books_.friction_work += pushed.lost;
  if (pairs_.empty()) return;
  const int a = field_of(facet(touch.own).body), b = field_of(facet(touch.facet).body);
  const std::size_t place = pairs_.at(a, b);
  if (pairs_.pair[place] < 0) return;
  const auto k = static_cast<std::size_t>(pairs_.pair[place]);
  const bool same = pairs_.group[static_cast<std::size_t>(a)] == pairs_.group[static_cast<std::size_t>(b)];
  books_.pair_impulse[k] += (pairs_.forward[place] && !(same && a > b) ? dt : -dt) * pushed.force;
  books_.pair_friction_work[k] += pushed.lost;
  if (touch.energy > 0)  // once a point; each of two surfaces is seen
    books_.pair_area[k] += 0.5 / kPoints * facet(touch.own).area;
}

template <int Dim>
void Penalty<Dim>::book_rigid(int point, const Vec<Dim>& force, const std::vector<Vec<Dim>>& pivots,
                              double dt) {
  if (force == Vec<Dim>::Zero()) return;
  const auto field =
      static_cast<std::size_t>(field_of(surfaces_->point_body[static_cast<std::size_t>(point)]));
  books_.rigid_impulse[field] += dt * force;
  const Vec<Dim> arm = at(point) - pivots[field];
  if constexpr (Dim == 2)
    books_.rigid_moment[field][2] += dt * moment<2>(arm, force);
  else
    books_.rigid_moment[field] += dt * moment<3>(arm, force);
  // What it moved by to be here did its work.
  books_.rigid_work -= force.dot(at(point) - before_[static_cast<std::size_t>(point)]);
}

template <int Dim>
double Penalty<Dim>::stored_energy(const State<Dim>& state) {
  if (!active_) return 0;
  look(state);
  double sum = stretch_energy_;
  for (const Room& room : rooms_)
    for (const Touch& touch : room.touches) sum += touch.energy;
  return sum;
}

template <int Dim>
std::size_t Penalty<Dim>::bytes() const {
  std::size_t sum =
      bytes_of(ball_, now_, before_, holds_, near_points_, near_facets_, is_near_, near_now_, shared_,
               listing_, listed_, listed_wedges_, listed_at_, wedge_normal_, bucket_begin_, binned_, force_);
  for (const Room& room : rooms_)
    sum += bytes_of(room.touches, room.pushed, room.squared, room.around, room.listing, room.listed,
                    room.binned);
  return sum;
}

template <int Dim>
void Penalty<Dim>::visit(Archive& archive) {
  if (!active_) return;
  archive.number("penalty/time", time_before_);
  archive.flag("penalty/known", known_);
  archive.number("penalty/stretch_energy", stretch_energy_);
  archive.number("penalty/pressed_peak", pressed_peak_);
  archive.column("penalty/positions", before_.data()->data(), Dim * before_.size());
  std::vector<std::uint64_t> steps;
  std::vector<int> pieces;
  std::vector<std::uint8_t> slides;
  std::vector<double> stretches;
  for (const Holds& holds : holds_) {
    steps.push_back(holds.step);
    for (const Hold& hold : holds.of) {
      pieces.push_back(hold.piece);
      slides.push_back(hold.slides);
      stretches.insert(stretches.end(), hold.stretch.data(), hold.stretch.data() + Dim);
    }
  }
  archive.column("penalty/steps", steps.data(), steps.size());
  archive.column("penalty/pieces", pieces.data(), pieces.size());
  archive.column("penalty/slides", slides.data(), slides.size());
  archive.column("penalty/stretches", stretches.data(), stretches.size());
  std::size_t k = 0;
  for (std::size_t p = 0; p < holds_.size(); ++p) {
    holds_[p].step = steps[p];
    for (Hold& hold : holds_[p].of) {
      hold.piece = pieces[k];
      hold.slides = slides[k] != 0;
      std::copy_n(stretches.data() + Dim * k, Dim, hold.stretch.data());
      ++k;
    }
  }
}

template class Penalty<2>;
template class Penalty<3>;

}  // namespace mpmfast
