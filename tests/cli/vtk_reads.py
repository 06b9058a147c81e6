#!/usr/bin/python3
"""The particle files as VTK's own reader sees them: times, vectors, tensors, and sums that history.csv has too.

usage: vtk_reads.py MPMFAST SOURCE_DIR
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

program, source = sys.argv[1:3]
try:
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    print("VTK or NumPy is missing: tools/setup tests")
    sys.exit(77)

SYMMETRIC = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
VECTOR = ["X", "Y", "Z"]
TENSOR = ["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"]


def read(path):
    """Points, arrays and time of a file; arrays as name -> (values, component names)."""
    reader = vtkXMLUnstructuredGridReader()
    faults = []
    reader.AddObserver("ErrorEvent", lambda *_: faults.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: faults.append("warning"))
    reader.SetFileName(str(path))
    reader.Update()
    assert not faults, f"{path}: {faults}"
    grid = reader.GetOutput()
    assert grid.GetNumberOfCells() == grid.GetNumberOfPoints()  # a vertex each, or ParaView shows nothing
    data = grid.GetPointData()
    arrays = {}
    for k in range(data.GetNumberOfArrays()):
        array = data.GetArray(k)
        names = [array.GetComponentName(c) for c in range(array.GetNumberOfComponents())]
        arrays[array.GetName()] = (vtk_to_numpy(array), names)
    time = grid.GetFieldData().GetArray("TimeValue").GetValue(0)
    return vtk_to_numpy(grid.GetPoints().GetData()), arrays, time


class VtkReads(unittest.TestCase):
    def test_grid(self):
        with tempfile.TemporaryDirectory() as work:
            out = pathlib.Path(work) / "run"
            command = [program, "run", f"{source}/configs/oblique_impact.yaml", "--out", out, "--progress", "none"]
            command += ["--set", "output.grid=true", "--set", "output.frames=12", "--until", "160 us"]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            series = xml.etree.ElementTree.parse(out / "grid.pvd").getroot()
            frames = [out / d.get("file") for d in series.iter("DataSet")]
            with open(out / "history.csv") as history:
                row = list(csv.DictReader(history))[-1]
            self.assertEqual(len(frames), 4)  # none before the first step
            points, arrays, time = read(frames[-1])
            self.assertAlmostEqual(time, 160e-6, delta=1e-9)
            values = {name: array for name, (array, _) in arrays.items()}
            for name in ["velocity", "contact_normal", "contact_impulse"]:
                self.assertEqual(arrays[name][1], VECTOR)
            mass = sum(float(row[f"{name}.mass_kg"]) for name in ["left", "right"])
            self.assertAlmostEqual(values["mass"].sum(), mass, delta=1e-8 * mass)  # the history has nine digits
            momentum = (values["mass"][:, None] * values["velocity"]).sum(axis=0)
            scale = 10 * mass
            self.assertAlmostEqual(momentum[0], 0, delta=1e-6 * scale)  # single precision
            self.assertAlmostEqual(momentum[1], 0, delta=1e-6 * scale)
            touching = values["touching"] == 1
            self.assertGreater(touching.sum(), 6)
            self.assertAlmostEqual(abs(values["contact_impulse"].sum(axis=0)).max(), 0, delta=1e-6 * scale)
            # The two fields of a node see one separation and opposite normals.
            left = {tuple(point): k for k, point in enumerate(points) if touching[k] and values["field"][k] == 0}
            right = {tuple(point): k for k, point in enumerate(points) if touching[k] and values["field"][k] == 1}
            self.assertEqual(left.keys(), right.keys())
            for point, k in left.items():
                normal = values["contact_normal"][k]
                self.assertAlmostEqual(numpy.linalg.norm(normal), 1, delta=1e-6)
                self.assertTrue((normal == -values["contact_normal"][right[point]]).all())
                self.assertEqual(values["separation"][k], values["separation"][right[point]])
                self.assertGreater(normal[0], 0)  # out of the left disk

    def run_and_compare(self, scene, *settings):
        with tempfile.TemporaryDirectory() as work:
            out = pathlib.Path(work) / "run"
            command = [program, "run", f"{source}/configs/{scene}", "--out", out, "--progress", "none"]
            for setting in settings:
                command += ["--set", setting]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            series = xml.etree.ElementTree.parse(out / "particles.pvd").getroot()
            self.assertEqual(series.get("type"), "Collection")
            frames = [(float(d.get("timestep")), out / d.get("file")) for d in series.iter("DataSet")]
            with open(out / "history.csv") as history:
                rows = list(csv.DictReader(history))
            self.assertGreater(len(frames), 2)
            for time, path in frames:
                points, arrays, stated = read(path)
                self.assertEqual(time, stated)
                self.assertEqual(arrays["velocity"][1], VECTOR)
                self.assertEqual(arrays["stress"][1], SYMMETRIC)
                self.assertEqual(arrays["deformation_gradient"][1], TENSOR)
                self.assertEqual(arrays["deformation_gradient"][0].dtype, numpy.float64)
                row = min(rows, key=lambda row: abs(float(row["time_s"]) - time))
                self.assertAlmostEqual(float(row["time_s"]), time, delta=1e-6 * frames[-1][0])
                self.compare(points, {name: values for name, (values, _) in arrays.items()}, row)

    def compare(self, points, arrays, row):
        volume, stress = arrays["volume"].astype(float), arrays["stress"].astype(float)
        size = max(abs(stress).max(), 1e-30)
        for k, name in enumerate(["xx", "yy", "zz", "xy"]):
            mean = (volume * stress[:, k]).sum() / volume.sum()
            self.assertAlmostEqual(mean, float(row[f"all.mean_stress_{name}_Pa"]), delta=1e-6 * size)
        self.assertTrue(numpy.allclose(arrays["pressure"], -stress[:, :3].mean(axis=1), atol=1e-6 * size))
        for body in numpy.unique(arrays["body"]):
            own = arrays["body"] == body
            name = [key[:-4] for key in row if key.endswith(".x_m")][body]
            weight = volume[own] / numpy.linalg.det(arrays["deformation_gradient"][own].reshape(-1, 3, 3))
            for axis, letter in enumerate("xy"):
                centre = (weight * points[own, axis]).sum() / weight.sum()
                speed = (weight * arrays["velocity"][own, axis]).sum() / weight.sum()
                self.assertAlmostEqual(centre, float(row[f"{name}.{letter}_m"]), delta=1e-6 * abs(points).max())
                fastest = max(abs(arrays["velocity"]).max(), 1e-30)
                self.assertAlmostEqual(speed, float(row[f"{name}.v{letter}"]), delta=2e-6 * fastest)

    def test_cracks(self):
        with tempfile.TemporaryDirectory() as work:
            out = pathlib.Path(work) / "run"
            command = [program, "run", f"{source}/configs/dcb.yaml", "--out", out, "--progress", "none"]
            subprocess.run(command + ["--until", "1 us", "--set", "output.frames=1000"], check=True, stdout=subprocess.DEVNULL)
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(out / "particles" / "000000.vtu"))
            reader.Update()
            data = reader.GetOutput().GetFieldData()
            points, lengths = (vtk_to_numpy(data.GetArray(name)) for name in ["crack_points", "crack_lengths"])
            self.assertEqual(points.shape, (lengths.sum(), 3))
            self.assertEqual(len(lengths), 1)
            with open(out / "history.csv") as history:
                row = next(csv.DictReader(history))
            crack = next(name for name in row if name.endswith(".end.J_J_per_m2"))[:-len(".J_J_per_m2")]
            self.assertEqual((float(row[f"{crack}.x_m"]), float(row[f"{crack}.y_m"]), 0), tuple(points[-1]))

    def test_plane(self):
        self.run_and_compare("uniaxial.yaml", "output.frames=4", "output.history=4")

    def test_space(self):
        self.run_and_compare("spheres.yaml", "output.frames=4", "output.history=4")


unittest.main(argv=sys.argv[:1])
