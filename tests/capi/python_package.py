#!/usr/bin/env python3
"""The Python package: the same bytes as the command line, arrays in and out, failures, cancel.

Usage: python_package.py BINARY LIBRARY SOURCE
"""
import csv
import filecmp
import os
import re
import subprocess
import sys
import tempfile
import unittest

BINARY, LIBRARY, SOURCE = (os.path.abspath(path) for path in sys.argv[1:4])
os.environ["THALWEG_LIBRARY"] = LIBRARY
sys.path.insert(0, f"{SOURCE}/tools/python")
sys.dont_write_bytecode = True
try:
    import numpy as np
except ImportError:
    print("no NumPy; skipped")
    sys.exit(77)
import thalweg

TINY = f"{SOURCE}/sample_terrains/tiny"
SURVEY = f"{SOURCE}/sample_terrains/survey"
JACKSBORO = f"{SOURCE}/sample_terrains/jacksboro"


def read_points(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))[1:]
    return np.array([[float(value) for value in row[:3]] for row in rows])


def read_line(path):
    with open(path) as file:
        numbers = re.search(r"\(([^)]*)\)", file.read()).group(1)
    return np.array([[float(value) for value in vertex.split()] for vertex in numbers.split(",")])


class Package(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def same_bytes(self, tin, *arguments, extensions=("ply", "nc", "2dm")):
        for extension in extensions:
            mine, theirs = (f"{self.folder.name}/{who}.{extension}" for who in ("mine", "theirs"))
            tin.write(mine)
            subprocess.run([BINARY, "build", *arguments[:1], theirs, "-q", *arguments[1:]], check=True)
            self.assertTrue(filecmp.cmp(mine, theirs, shallow=False), extension)

    def test_arrays_of_points_and_lines(self):
        tin = thalweg.build(read_points(f"{TINY}/points.csv"), valleys=[read_line(f"{TINY}/valley.csv")],
                            ridges=[read_line(f"{TINY}/ridge.csv")])
        self.same_bytes(tin, f"{TINY}/points.csv", "--valleys", f"{TINY}/valley.csv", "--ridges", f"{TINY}/ridge.csv")

    def test_points_from_an_array_and_lines_from_files(self):
        lines = {kind: f"{SURVEY}/lines.gpkg|layername={kind}" for kind in ("valleys", "ridges")}
        tin = thalweg.build(read_points(f"{SURVEY}/points.csv"), crs="EPSG:32632", **lines)
        self.same_bytes(tin, f"{SURVEY}/points.csv", "--a-crs", "EPSG:32632", "--valleys", lines["valleys"],
                        "--ridges", lines["ridges"])
        self.assertIn("32632", tin.crs)

    def test_a_dem_simplified(self):
        options = {"max_error": 20, "optimize": ["local-minima", "normal-angle-sum"], "definition": "sees-opp"}
        tin = thalweg.build(f"{JACKSBORO}/dem.tif", valleys=f"{JACKSBORO}/lines.gpkg|layername=valleys", **options)
        self.same_bytes(tin, f"{JACKSBORO}/dem.tif", "--valleys", f"{JACKSBORO}/lines.gpkg|layername=valleys",
                        "--max-error", "20")
        self.assertLessEqual(tin.report["simplification"]["largest_error_m"]["result"], 20)

    def test_a_tin_that_exists(self):
        given, mine, theirs = (f"{self.folder.name}/{name}.ply" for name in ("given", "mine", "theirs"))
        lines = f"{SURVEY}/lines.gpkg|layername=valleys"
        subprocess.run([BINARY, "build", f"{SURVEY}/points.csv", given, "-q", "--valleys", lines, "--a-crs",
                        "EPSG:32632", "--order", "0"], check=True)
        tin = thalweg.optimize(given, optimize="edge-length")
        tin.write(mine)
        subprocess.run([BINARY, "optimize", given, theirs, "-q", "--optimize", "edge-length"], check=True)
        self.assertTrue(filecmp.cmp(mine, theirs, shallow=False))
        self.assertGreater(len(tin.constraints[1]), 0)
        with self.assertRaises(thalweg.ThalwegError) as raised:
            thalweg.optimize(given, max_error=1)
        self.assertEqual(raised.exception.code, "usage")
        with self.assertRaises(thalweg.ThalwegError) as raised:
            thalweg.optimize("missing.ply")
        self.assertEqual(raised.exception.code, "not-found")

    def test_what_comes_back(self):
        points = np.array([[x, y, (3 * x + y) % 4] for y in range(6) for x in range(7)], float)
        tin = thalweg.build(points, breaklines=[[[0, 0], [3, 2]], [[3, 2], [6, 5]]], optimize="none")
        self.assertTrue((tin.vertices[:len(points)] == points).all())
        self.assertEqual(tin.triangles.shape[1], 3)
        self.assertEqual(tin.triangles.dtype, np.uint32)
        corner = tin.vertices[tin.triangles][:, :, :2]
        u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
        twice = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        self.assertTrue((twice > 0).all())
        self.assertAlmostEqual(twice.sum() / 2, 30)
        self.assertTrue((tin.triangles[:, 0] == tin.triangles.min(axis=1)).all())
        self.assertEqual(tin.orders.max(), 0)
        ends, kinds = tin.constraints
        self.assertEqual(len(ends), len(kinds))
        self.assertEqual(set(kinds), {thalweg.BREAKLINE})
        self.assertEqual(tin.report["thalweg"]["version"], thalweg.version())
        ring = [[0.5, 0.5], [4.5, 0.5], [4.5, 3.5], [0.5, 3.5], [0.5, 0.5]]
        inner = [[1.5, 1.5], [2.5, 1.5], [2.5, 2.5], [1.5, 2.5], [1.5, 1.5]]
        area = thalweg.build(points, boundary=[ring], holes=[inner]).report["tin"]["area_m2"]
        self.assertAlmostEqual(area, 4 * 3 - 1)
        pond = thalweg.build(points, lakes=[[[x, y, 0.25] for x, y in ring]])
        wet = (pond.vertices[:, 0] >= 0.5) & (pond.vertices[:, 0] <= 4.5)
        wet &= (pond.vertices[:, 1] >= 0.5) & (pond.vertices[:, 1] <= 3.5)
        self.assertEqual(set(pond.vertices[wet, 2]), {0.25})
        self.assertEqual(pond.report["input"]["lakes"], 1)
        self.assertEqual(set(pond.constraints[1]), {thalweg.LAKE})

    def test_failures(self):
        points = np.zeros((5, 3))
        for code, call in {
            "too-few-points": lambda: thalweg.build(points),
            "usage": lambda: thalweg.build(points, no_such_option=1),
            "not-found": lambda: thalweg.build("no-such-file.csv"),
        }.items():
            with self.assertRaises(thalweg.ThalwegError) as caught:
                call()
            self.assertEqual(caught.exception.code, code)
            self.assertTrue(caught.exception.message)
        with self.assertRaises(ValueError):
            thalweg.build(np.zeros((5, 2)))
        with self.assertRaises(ValueError):
            thalweg.build(np.zeros((5, 3)), ridges=[[1, 2, 3]])
        tin = thalweg.build(f"{TINY}/points.csv")
        path = f"{self.folder.name}/tin.gpkg"
        tin.write(path, options={"LAYERS": "triangles"})
        with self.assertRaises(thalweg.ThalwegError) as caught:
            tin.write(path)
        self.assertEqual(caught.exception.code, "output-exists")
        tin.write(path, overwrite=True)

    def test_progress_and_cancel(self):
        seen = []
        thalweg.build(f"{TINY}/points.csv", progress=lambda phase, fraction: seen.append((phase, fraction)))
        self.assertIn("optimize", {phase for phase, _ in seen})
        self.assertTrue(all(0 <= fraction <= 1 for _, fraction in seen))
        with self.assertRaises(thalweg.ThalwegError) as caught:
            thalweg.build(f"{TINY}/points.csv", progress=lambda phase, fraction: phase == "optimize")
        self.assertEqual(caught.exception.code, "cancelled")
        calls = len(seen)

        def fail_at_last(phase, fraction):
            seen.append((phase, fraction))
            if len(seen) == 2 * calls:
                raise KeyError(phase)

        with self.assertRaises(KeyError):
            thalweg.build(f"{TINY}/points.csv", progress=fail_at_last)

        def fail(phase, fraction):
            raise KeyError(phase)

        with self.assertRaises(KeyError):
            thalweg.build(f"{TINY}/points.csv", progress=fail)

    def test_every_option_of_the_command_line_is_known_by_name(self):
        text = subprocess.run([BINARY, "build", "--help"], check=True, capture_output=True, text=True).stdout
        outputs = {"help", "of", "co", "overwrite", "report", "picture", "dump-problem", "quiet", "progress", "format",
                   "proof", "version", "condition-layer"}
        names = set(re.findall(r"--([a-z-]+)", text)) - outputs
        self.assertGreater(len(names), 20)
        for name in sorted(names):
            with self.assertRaises(thalweg.ThalwegError) as caught:
                thalweg.build("no-such-file.csv", **{name: "no such value"})
            self.assertNotIn("there is no option", caught.exception.message, name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
