#!/usr/bin/python3
"""Two codes coupled: mpmfast moves the bodies, this script the air around them, which drags on every particle.

usage: drag.py SCENE.yaml [RATE in 1/s]
"""
import sys

import mpmfast


def main(scene, rate=1000.0, rows=10):
    simulation = mpmfast.Simulation(scene)
    axes = ["velocity.x", "velocity.y", "velocity.z"][: simulation.dimension]
    print("time_s,kinetic_J,stored_J,work_of_drag_J")
    for row in range(rows + 1):
        until = simulation.end * row / rows
        while until - simulation.time > 1e-12 * until:  # what round-off leaves is no step
            dt = min(simulation.stable_dt, until - simulation.time)
            for axis, name in enumerate(axes):
                simulation.add_velocity(axis, -rate * dt * simulation[name])
            simulation.advance(dt)
        energies = simulation.energies
        print(f"{simulation.time:.6e},{energies['kinetic']:.6e},{energies['stored']:.6e},"
              f"{energies['body_force_work']:.6e}")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], *map(float, sys.argv[2:3]))
