#pragma once

/// @file What the boundaries do to the material in a step: forces and work.

#include <vector>

#include "engine/state/state.hpp"

namespace mpmfast {

/// The reaction of a boundary that moves with u has two parts. One answers the forces on nodes. Material
/// there moves with the boundary, so the work of this part is that at u. The other, I = s m (u − v_s), is
/// what particles take of the velocities v_s that they bring. Their kinetic energy grows by I·½(v_s + v′) (v′
/// from kernels/transfer/re_extrapolate.hpp), and that is its work. Taken as I·u it would be too large by s
/// ½ m (u − v_s)² and more in every step, since particles follow a boundary that accelerates with a delay.
///
/// The work of a boundary that never moves is zero. What it takes of motion is a loss.
template <int Dim>
struct BoundaryLedger {
  std::vector<Vec<Dim>> force;  ///< on the material, as Scene::boundaries, N
  double work = 0;              ///< of the boundaries on the material, J
  double friction_work = 0;     ///< that friction took, J

  /// Impulses I along a direction, N s, whose work was or will be entered as I u; v_s and u along it,
  /// m/s.
  struct Taken {
    int slot;
    Vec<Dim> direction;
    double impulse, start, speed;
  };
  std::vector<Taken> taken;

  /// Begins a step.
  void open() {
    work = friction_work = 0;
    for (Vec<Dim>& f : force) f.setZero();
    taken.clear();
  }

  /// Replaces I u by I ½(v_s + v′).
  /// @param end  v′ along the direction of an impulse, m/s
  template <class Velocity>
  void settle(Velocity end) {
    for (const Taken& t : taken) work += t.impulse * (0.5 * (t.start + end(t)) - t.speed);
    taken.clear();
  }
};

}  // namespace mpmfast
