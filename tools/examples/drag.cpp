/// @file Two codes coupled: mpmfast moves the bodies, this program the air around them, which drags on every
/// particle. usage: drag SCENE.yaml [RATE in 1/s]

#include <mpmfast/simulation.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: drag SCENE.yaml [RATE in 1/s]\n");
    return 2;
  }
  mpmfast::use_quiet_threads(arguments);
  const double rate = count > 2 ? std::atof(arguments[2]) : 1000;
  try {
    mpmfast::Simulation simulation(arguments[1]);
    const char* const components[] = {"velocity.x", "velocity.y", "velocity.z"};
    std::vector<double> change(simulation.particles());
    std::printf("time_s,kinetic_J,stored_J,work_of_drag_J\n");
    constexpr int kRows = 10;
    for (int row = 0; row <= kRows; ++row) {
      const double until = simulation.end() * row / kRows;
      while (until - simulation.time() > 1e-12 * until) {  // what round-off leaves is no step
        const double dt = std::min(simulation.stable_dt(), until - simulation.time());
        for (int axis = 0; axis < simulation.dimension(); ++axis) {
          // The span shows the particles as they lie now; after a step it would have to be asked for again.
          const auto velocity = simulation.column(components[axis]);
          for (std::size_t p = 0; p < velocity.size(); ++p) change[p] = -rate * dt * velocity[p];
          simulation.add_velocity(axis, change);
        }
        simulation.advance(dt);
      }
      const mpmfast::Energies energies = simulation.energies();
      std::printf("%.6e,%.6e,%.6e,%.6e\n", simulation.time(), energies.kinetic, energies.stored,
                  energies.body_force_work);
    }
  } catch (const mpmfast::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
}
