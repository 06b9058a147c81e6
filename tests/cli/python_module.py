#!/usr/bin/python3
"""The Python module: views share memory, steps are those of the program, faults become exceptions.

usage: python_module.py MODULE_FOLDER MPMFAST SOURCE_DIR
"""
import ast
import contextlib
import csv
import ctypes
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

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
ENDLESS = {"time.end": "1000 s", "bodies.0.velocity": [0, 0], "output.frames": 0}
HEAVY = {"materials.soft.density": "1000 g/cm^3", "bodies.0.velocity": [0, 0]}


@contextlib.contextmanager
def interruption(after=0.5, before=lambda: None):
    """Ctrl-C after some seconds, from another thread, which calls `before` first."""
    def interrupt():
        time.sleep(after)
        before()
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    yield
    thread.join()


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

    def test_steps_one_by_one_are_those_of_the_program(self):
        with tempfile.TemporaryDirectory() as work:
            settings = {"time.end": "20 us", "output.frames": 0, "output.picture": None}
            summary = mpmfast.run(RING, pathlib.Path(work) / "run", settings)
        simulation = mpmfast.Simulation(RING, settings)
        passed = 0
        while not simulation.finished:
            passed += simulation.step()
        self.assertEqual((simulation.steps, simulation.checksum), (summary["steps"], summary["checksum"]))
        self.assertAlmostEqual(passed, simulation.end, delta=1e-12 * simulation.end)
        self.assertEqual(simulation.step(), 0)
        self.assertEqual(simulation.steps, summary["steps"])

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

    def test_values_of_settings(self):
        simulation = mpmfast.Simulation(IMPACT, {
            "contact.pairs": ({"between": ("left", "right"), "friction": numpy.float64(0.25)},),
            "output.overlap": True, "output.checkpoint": {"every": None, "steps": numpy.int32(7)},
            "output.picture": None, "time.cfl": numpy.array(0.25)})
        resolved = " ".join(simulation.resolved_scene.split())
        for words in ("overlap: true", "steps: 7", "picture: none", "cfl: 0.25", "friction: 0.25"):
            self.assertIn(words, resolved)

    def test_names_of_columns(self):
        simulation = mpmfast.Simulation.from_text(SCENE)
        self.assertIn("velocity.x", simulation)
        self.assertNotIn("velocity.z", simulation)
        self.assertNotIn(1, simulation)
        self.assertEqual(list(simulation), simulation.columns)
        self.assertEqual(simulation.keys(), simulation.columns)
        self.assertEqual(len(dict(simulation)["mass"]), len(simulation))
        with self.assertRaises(KeyError):
            simulation.unit("velocity.z")

    def test_everything_is_described_and_stands_in_the_stub(self):
        public = {name for name in dir(mpmfast.Simulation) if not name.startswith("_")}
        for name in public:
            self.assertTrue(getattr(mpmfast.Simulation, name).__doc__, name)
        tree = ast.parse((pathlib.Path(folder) / "mpmfast" / "__init__.pyi").read_text())
        words = {node.name: node for node in tree.body if hasattr(node, "name")}
        members = {node.name for node in words["Simulation"].body}
        self.assertEqual({name for name in members if not name.startswith("_")}, public)
        self.assertLessEqual(members, set(dir(mpmfast.Simulation)))
        self.assertEqual(set(words), set(mpmfast.__all__))
        self.assertTrue((pathlib.Path(folder) / "mpmfast" / "py.typed").exists())
        self.assertEqual(repr(mpmfast.SceneError), "<class 'mpmfast.SceneError'>")

    def test_threads_that_wait_do_not_spin_unless_they_are_told(self):
        environment = {name: text for name, text in os.environ.items()
                       if name not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
        code = "import os, mpmfast; print(os.environ.get('GOMP_SPINCOUNT'))"
        for told, spins, left in (({}, "1000", "None"), ({"GOMP_SPINCOUNT": "77"}, "77", "77"),
                                  ({"OMP_WAIT_POLICY": "passive"}, "0", "None")):
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env={
                **environment, "PYTHONPATH": folder, "OMP_DISPLAY_ENV": "verbose", **told})
            self.assertIn(f"GOMP_SPINCOUNT = '{spins}'", done.stderr)
            self.assertEqual(done.stdout.strip(), left)

    def test_control_c_ends_the_steps(self):
        simulation = mpmfast.Simulation.from_text(SCENE, set=ENDLESS)
        with interruption(), self.assertRaises(KeyboardInterrupt):
            simulation.advance_to(simulation.end)
        self.assertGreater(simulation.steps, 0)
        simulation.step()  # as if nothing had been

    def test_control_c_ends_a_run_with_a_checkpoint(self):
        with tempfile.TemporaryDirectory() as work:
            out = pathlib.Path(work) / "out"
            (out.parent / "scene.yaml").write_text(SCENE)
            with interruption(), self.assertRaises(KeyboardInterrupt):
                mpmfast.run(out.parent / "scene.yaml", out, ENDLESS)
            summary = json.loads((out / "run.json").read_text())
            self.assertEqual((summary["status"], summary["reason"]), ("stopped", "request"))
            until = summary["time_s"] + 1e-4
            subprocess.run([program, "resume", out, "--until", f"{until!r} s", "--progress", "none"], check=True,
                           stdout=subprocess.DEVNULL)

    def test_one_thread_at_a_time(self):
        simulation = mpmfast.Simulation.from_text(SCENE, set=ENDLESS)
        refused = []

        def meddle():
            for use in (lambda: simulation.time, lambda: simulation["mass"], lambda: simulation.step()):
                try:
                    use()
                except RuntimeError as error:
                    refused.append(str(error))

        with interruption(before=meddle), self.assertRaises(KeyboardInterrupt):
            simulation.advance_to(simulation.end)
        self.assertEqual(refused, ["the simulation is being advanced by another thread"] * 3)
        self.assertGreater(simulation.time, 0)

    def test_threads_are_those_of_the_run_alone(self):
        count = ctypes.CDLL("libgomp.so.1").omp_get_max_threads
        before = count()
        with tempfile.TemporaryDirectory() as work:
            scene = pathlib.Path(work) / "scene.yaml"
            scene.write_text(SCENE)
            settings = {"time.end": "2 us", "output.frames": 0, "grid.cell": "0.1 mm"}  # 9600 particles
            checksums = set()
            for threads in (1, before + 1):
                summary = mpmfast.run(scene, f"{work}/{threads}", settings, threads=threads)
                self.assertEqual((summary["threads"], count()), (min(threads, 9), before))
                simulation = mpmfast.Simulation(scene, settings, threads=threads)
                simulation.advance_to(simulation.end)
                self.assertEqual(count(), before)
                checksums |= {summary["checksum"], simulation.checksum}
            self.assertEqual(len(checksums), 1)
            for threads in (-1, 10**6):
                with self.assertRaisesRegex(ValueError, "not a number of threads"):
                    mpmfast.run(RING, f"{work}/wrong", threads=threads)
                with self.assertRaisesRegex(ValueError, "not a number of threads"):
                    mpmfast.Simulation(RING, threads=threads)

    def test_what_looks_mistaken_is_told(self):
        with tempfile.TemporaryDirectory() as work:
            scene = pathlib.Path(work) / "scene.yaml"
            scene.write_text(SCENE)
            with self.assertWarnsRegex(UserWarning, "no density of a solid"):
                simulation = mpmfast.Simulation(scene, HEAVY)
            self.assertIn("no density of a solid", "".join(simulation.warnings))
            with self.assertWarnsRegex(UserWarning, "no density of a solid") as told:
                summary = mpmfast.run(scene, f"{work}/out", HEAVY)
            self.assertEqual(told.filename, __file__)
            self.assertIn("no density of a solid", "".join(summary["warnings"]))
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                mpmfast.Simulation(scene, {"time.end": "40 us"})
                for use in (lambda: mpmfast.Simulation(scene, HEAVY), lambda: mpmfast.run(scene, f"{work}/no", HEAVY)):
                    with self.assertRaisesRegex(UserWarning, "no density of a solid"):
                        use()
            self.assertFalse(os.path.exists(f"{work}/no"))

    def test_the_peak_of_memory_is_that_of_the_run(self):
        much = numpy.ones(2**26)  # 512 MiB
        del much
        with tempfile.TemporaryDirectory() as work:
            summary = mpmfast.run(RING, f"{work}/out", {"time.end": "2 us", "output.frames": 0})
        self.assertLess(summary["peak_memory_bytes"], 2**29)

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
            with self.assertRaisesRegex(mpmfast.FileError, "with force"):
                mpmfast.run(RING, f"{work}/out")
            mpmfast.run(RING, f"{work}/out", {"time.end": "2 us", "output.frames": 0}, force=True)


unittest.main(argv=sys.argv[:1], warnings="ignore")
