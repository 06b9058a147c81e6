#!/usr/bin/python3
"""The Python module: views share memory, steps are those of the program, faults become exceptions.

usage: python_module.py MODULE_FOLDER MPMFAST SOURCE_DIR
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

folder, program, source = sys.argv[1:4]
sys.path.insert(0, folder)
try:
    import numpy
except ImportError:
    print("NumPy is missing: tools/setup tests")
    sys.exit(77)
import mpmfast

RING = f"{source}/configs/thick_ring.yaml"
IMPACT = f"{source}/configs/starters/impact.yaml"
SPHERE = f"{source}/configs/sphere_plane.yaml"
SCENE = """
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 20 us}
materials: {soft: {model: neo_hookean, density: 1000 kg/m^3, young: 10 MPa, poisson: 0.3}}
bodies:
  - {name: left, box: {from: [1 mm, 2 mm], to: [4 mm, 6 mm]}, material: soft, velocity: [5, 0]}
  - {name: right, box: {from: [5 mm, 2 mm], to: [8 mm, 6 mm]}, material: soft}
"""


def kind_of(column):
    """The quantity of a column of the history: without its body and its component."""
    return re.sub("[xyz]+", "", column.rsplit(".")[-1])


class PythonModule(unittest.TestCase):
    def test_steps_are_those_of_the_program(self):
        for scene, until in [(RING, 4e-5), (SPHERE, 2e-5)]:
            with tempfile.TemporaryDirectory() as work:
                out = pathlib.Path(work) / "run"
                simulation = mpmfast.Simulation(scene)
                until = min(until, simulation.end)
                steps = simulation.advance_to(until)
                command = [program, "run", scene, "--until", f"{until!r} s", "--out", out, "--progress", "none"]
                subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
                summary = json.loads((out / "run.json").read_text())
                self.assertGreater(steps, 3)
                self.assertEqual(simulation.checksum, summary["checksum"])
                self.assertEqual(steps, summary["steps"])

    def test_the_history_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as work:
            out = pathlib.Path(work) / "run"
            settings = {"output.history": "1", "time.end": "150 us", "output.overlap": "true",
                        "contact.pairs": "[{between: [left, right], friction: 0.3}]"}
            summary = mpmfast.run(IMPACT, out=str(out), set=settings)
            rows = list(csv.DictReader((out / "history.csv").read_text().splitlines()))
        self.assertEqual((len(rows), summary["status"]), (2, "finished"))
        largest = {}  # of all components of a vector or tensor: round-off of those that symmetry makes zero
        for row in rows:
            for name, text in row.items():
                largest[kind_of(name)] = max(largest.get(kind_of(name), 0), abs(float(text)))
        simulation = mpmfast.Simulation(IMPACT, set=settings)
        for row, time in zip(rows, (0, 150e-6)):
            simulation.advance_to(time)
            now = simulation.history()
            self.assertEqual(list(now), list(row))
            for name, text in row.items():
                delta = 1e-8 * abs(float(text)) + 1e-12 * largest[kind_of(name)]
                self.assertAlmostEqual(now[name], float(text), delta=delta, msg=name)
        self.assertTrue(any(now[name] for name in now if ".force_" in name))

    def test_views_share_the_memory_of_the_simulation(self):
        simulation = mpmfast.Simulation.from_text(SCENE)
        first, second = simulation["velocity.x"], simulation["velocity.x"]
        self.assertEqual(first.ctypes.data, second.ctypes.data)
        self.assertEqual(first.dtype, numpy.float64)
        self.assertFalse(first.flags.writeable)
        with self.assertRaises(ValueError):
            first[0] = 1
        self.assertEqual(len(first), len(simulation))
        simulation.add_velocity(0, numpy.full(len(simulation), 2.0))
        self.assertEqual(set(first), {7.0, 2.0})
        del simulation
        self.assertEqual(set(first), {7.0, 2.0})  # a view keeps it alive

    def test_columns(self):
        simulation = mpmfast.Simulation.from_text(SCENE)
        self.assertIn("kirchhoff_stress.zz", simulation.columns)
        self.assertEqual(simulation.unit("kirchhoff_stress.zz"), "Pa")
        x, y = simulation["position.x"], simulation["position.y"]
        body = simulation.bodies
        self.assertEqual(simulation.body_names, ["left", "right"])
        self.assertTrue(((x < 4e-3) == (body == 0)).all())
        self.assertTrue(((y > 2e-3) & (y < 6e-3)).all())
        self.assertAlmostEqual(simulation["mass"].sum(), 1000 * 2 * 12e-6, delta=1e-12)
        self.assertEqual(sorted(simulation.ids), list(range(len(simulation))))
        self.assertEqual(simulation["deformation_gradient.xx"].min(), 1)
        self.assertEqual(simulation["deformation_gradient.yx"].max(), 0)
        with self.assertRaises(KeyError):
            simulation["velocity.z"]

    def test_momentum_and_energy(self):
        simulation = mpmfast.Simulation.from_text(SCENE)
        before = simulation.energies
        for _ in range(5):
            simulation.advance(simulation.stable_dt)
        self.assertEqual(simulation.steps, 5)
        momentum = (simulation["mass"] * simulation["velocity.x"]).sum()
        self.assertAlmostEqual(momentum, 1000 * 12e-6 * 5, delta=1e-12)
        self.assertAlmostEqual(before["kinetic"], 0.5 * 1000 * 12e-6 * 25, delta=1e-12)

    def test_settings(self):
        simulation = mpmfast.Simulation(RING, {"grid.cell": "0.5 mm", "output.overlap": False})
        self.assertEqual(len(simulation), 4 * len(mpmfast.Simulation(RING)))
        self.assertIn("overlap: false", simulation.resolved_scene)

    def test_faults(self):
        with self.assertRaisesRegex(mpmfast.SceneError, "time.edn: unknown key"):
            mpmfast.Simulation.from_text(SCENE.replace("end:", "edn:"))
        with self.assertRaisesRegex(mpmfast.FileError, "no such file"):
            mpmfast.Simulation("nowhere.yaml")
        simulation = mpmfast.Simulation.from_text(SCENE)
        with self.assertRaises(ValueError):
            simulation.add_velocity(0, [1.0])
        with self.assertRaises(ValueError):
            simulation.add_velocity(2, numpy.zeros(len(simulation)))
        with self.assertRaises(ValueError):
            simulation.add_velocity(0, numpy.full(len(simulation), numpy.nan))
        with self.assertRaises(ValueError):
            simulation.advance(-1)
        simulation.add_velocity(0, numpy.full(len(simulation), 3e5))
        with self.assertRaisesRegex(mpmfast.RunFailure, "left the grid|outside"):
            for _ in range(1000):
                simulation.advance(simulation.stable_dt)

    def test_run(self):
        with tempfile.TemporaryDirectory() as work:
            summary = mpmfast.run(RING, f"{work}/out", {"time.end": "2 us", "output.frames": 0}, threads=1)
            self.assertEqual(summary["status"], "finished")
            self.assertEqual(summary["threads"], 1)
            with self.assertRaises(mpmfast.FileError):
                mpmfast.run(RING, f"{work}/out")


unittest.main(argv=sys.argv[:1])
