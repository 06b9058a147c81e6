#include "engine/contact/penalty/friction.hpp"

#include <algorithm>
#include <cmath>

#include "engine/state/surfaces.hpp"

namespace mpmfast::penalty {

namespace {

struct FrictionLimit {
  double normal, speed;
  bool slides;

  double operator()(const Coulomb& law) const {
    return (slides ? law.friction : std::max(law.friction, law.static_friction)) * normal;
  }
  double operator()(const VelocityFriction& law) const {
    const double at_rest = std::max(law.friction, law.static_friction);
    return (law.friction + (at_rest - law.friction) * std::exp(-speed / law.decay_speed)) * normal;
  }
  double operator()(const Stick&) const { return kSticks; }
  /// `frictionless`; the scene refuses other laws, and films and `ignore` have no spring.
  template <class Other>
  double operator()(const Other&) const {
    return 0;
  }
};

}  // namespace

double friction_limit(const AnyLaw& law, double normal, double speed, bool slides) {
  return std::visit(FrictionLimit{normal, speed, slides}, law);
}

template <int Dim>
void stretch_spring(TangentialSpring<Dim>& spring, const Vec<Dim>& slip, const Vec<Dim>& exit_direction) {
  const double length = spring.stretch.norm();
  Vec<Dim> turned = spring.stretch - spring.stretch.dot(exit_direction) * exit_direction;
  const double left = turned.norm();
  if (left > 0) turned *= length / left;
  spring.stretch = turned + slip;
}

template <int Dim>
TangentialForce<Dim> return_to_limit(TangentialSpring<Dim>& spring, double stiffness, double limit) {
  TangentialForce<Dim> out{};
  const double trial = stiffness * spring.stretch.norm();
  spring.slides = trial > limit;
  if (spring.slides) {
    const Vec<Dim> reduced = limit / trial * spring.stretch;
    out.dissipated = (spring.stretch - reduced).norm() * limit;
    spring.stretch = reduced;
  }
  out.stored = 0.5 * stiffness * spring.stretch.squaredNorm();
  out.force = -stiffness * spring.stretch;
  return out;
}

template <int Dim>
TangentialSpring<Dim> PointSprings<Dim>::restore(int patch, std::uint64_t now) const {
  if (step + 1 == now)
    for (const TangentialSpring<Dim>& spring : springs)
      if (spring.patch == patch) return spring;
  return {};
}

/// The names in a checkpoint stay, so that older checkpoints can be read.
template <int Dim>
void FrictionHistory<Dim>::visit(Archive& archive) {
  std::vector<std::uint64_t> steps;
  std::vector<int> patches;
  std::vector<std::uint8_t> slides;
  std::vector<double> stretches;
  for (const auto& point : points_) {
    steps.push_back(point.step);
    for (const auto& spring : point.springs) {
      patches.push_back(spring.patch);
      slides.push_back(spring.slides);
      stretches.insert(stretches.end(), spring.stretch.data(), spring.stretch.data() + Dim);
    }
  }
  archive.column("penalty/steps", steps.data(), steps.size());
  archive.column("penalty/pieces", patches.data(), patches.size());
  archive.column("penalty/slides", slides.data(), slides.size());
  archive.column("penalty/stretches", stretches.data(), stretches.size());
  std::size_t k = 0;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    points_[p].step = steps[p];
    for (auto& spring : points_[p].springs) {
      spring.patch = patches[k];
      spring.slides = slides[k] != 0;
      std::copy_n(stretches.data() + Dim * k, Dim, spring.stretch.data());
      ++k;
    }
  }
}

template <int Dim>
std::size_t FrictionHistory<Dim>::bytes() const {
  return bytes_of(points_);
}

template struct PointSprings<2>;
template struct PointSprings<3>;
template class FrictionHistory<2>;
template class FrictionHistory<3>;
template void stretch_spring<2>(TangentialSpring<2>&, const Vec<2>&, const Vec<2>&);
template void stretch_spring<3>(TangentialSpring<3>&, const Vec<3>&, const Vec<3>&);
template TangentialForce<2> return_to_limit<2>(TangentialSpring<2>&, double, double);
template TangentialForce<3> return_to_limit<3>(TangentialSpring<3>&, double, double);

}  // namespace mpmfast::penalty
