#!/usr/bin/env python3
"""The same inputs through the command line, C, Python and QGIS give the same bytes of mesh.

Four inputs: points with lines of a GeoPackage, a DEM in degrees with valleys, points by the hull heuristic at order 2, a DEM that is simplified; and the first
result, optimised anew. A face that is not there (NumPy, QGIS) is named and left out.

Usage: faces.py BINARY LIBRARY C_PROGRAM SOURCE
"""
import json
import os
import subprocess
import sys
import tempfile

from qgis_plugin import PYTHON, QGIS_PROCESS, Bench

BINARY, LIBRARY, C_PROGRAM, SOURCE = (os.path.abspath(path) for path in sys.argv[1:5])
SURVEY, HILLS = (f"{SOURCE}/sample_terrains/{name}" for name in ("survey", "jacksboro"))

# Each a name, the points, options of the command line, and for QGIS the algorithm and its parameters.
BUILDS = [
    ("survey", "points.gpkg", {"z-field": "z", "valleys": f"{SURVEY}/lines.gpkg|layername=valleys",
                               "ridges": f"{SURVEY}/lines.gpkg|layername=ridges"},
     ("build", {"Z_FIELD": "z", "VALLEYS": f"{SURVEY}/lines.gpkg|layername=valleys",
                "RIDGES": f"{SURVEY}/lines.gpkg|layername=ridges"})),
    ("degrees", f"{HILLS}/dem.tif", {"valleys": f"{HILLS}/lines.gpkg|layername=valleys_3d", "definition": "pathcon"},
     ("build", {"VALLEYS": f"{HILLS}/lines.gpkg|layername=valleys_3d", "DEFINITION": 2})),
    ("hulls", "points.gpkg", {"z-field": "z", "order": "2", "method": "hull"},
     ("build", {"Z_FIELD": "z", "ORDER": 2, "METHOD": 2})),
    ("simplified", f"{HILLS}/dem.tif", {"max-error": "12", "ridges": f"{HILLS}/lines.gpkg|layername=ridges"},
     ("simplify", {"MAX_ERROR": 12, "RIDGES": f"{HILLS}/lines.gpkg|layername=ridges"})),
]

IN_PYTHON = """
import json, sys
import thalweg
output, source, options = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
options = {name.replace("-", "_"): value for name, value in options.items()}
tin = thalweg.optimize(source, **options) if sys.argv[4] == "optimize" else thalweg.build(source, **options)
tin.write(output)
"""


class Faces:
    def __init__(self, folder):
        self.folder = folder
        self.bench = Bench(BINARY, SOURCE, folder)
        self.failed = 0
        self.python_env = dict(os.environ, PYTHONPATH=f"{SOURCE}/tools/python", THALWEG_LIBRARY=LIBRARY,
                               PYTHONDONTWRITEBYTECODE="1")
        has_numpy = subprocess.run([PYTHON, "-c", "import numpy"], capture_output=True).returncode == 0
        self.others = ["C"] + (["Python"] if has_numpy else []) + (["QGIS"] if QGIS_PROCESS else [])
        for name in {"Python", "QGIS"} - set(self.others):
            print(f"skip {name}: it is not installed")
        if QGIS_PROCESS:
            self.bench.run(QGIS_PROCESS, "plugins", "enable", "thalweg_tin")

    def path(self, name):
        return f"{self.folder}/{name}"

    def call(self, *command, env=None):
        done = subprocess.run(command, cwd=self.folder, env=env, capture_output=True, text=True, timeout=400)
        return done.returncode, done.stdout + done.stderr

    def through(self, face, job, source, output, options, qgis):
        """Runs `job`, build or optimize, through one face."""
        if face == "command line":
            return self.call(BINARY, job, source, output, "-q", *(f"--{name}={value}" for name, value in options.items()))
        if face == "C":
            first = f"--tin={source}" if job == "optimize" else source
            return self.call(C_PROGRAM, output, first, *(f"{name}={value}" for name, value in options.items()))
        if face == "Python":
            return self.call(PYTHON, "-c", IN_PYTHON, output, source, json.dumps(options), job, env=self.python_env)
        algorithm, parameters = qgis
        return self.bench.run(QGIS_PROCESS, "run", f"thalweg:{algorithm}", f"--INPUT={source}", f"--OUTPUT={output}",
                              *(f"--{name}={value}" for name, value in parameters.items()))

    def compare(self, name, job, source, options, qgis):
        outputs = {}
        for face in ["command line", *self.others]:
            output = self.path(f"{name}_{face.replace(' ', '_')}.ply")
            status, text = self.through(face, job, source, output, options, qgis)
            if status != 0 or not os.path.exists(output):
                print(f"FAIL {name}, {face}: status {status}: {text[-600:]}", flush=True)
                self.failed += 1
                continue
            with open(output, "rb") as file:
                outputs[face] = file.read()
        same = len(set(outputs.values())) == 1 and len(outputs) == 1 + len(self.others)
        self.failed += not same
        print(f"{'ok  ' if same else 'FAIL'} {name}: {', '.join(outputs)}; "
              + ", ".join(sorted({str(len(data)) for data in outputs.values()})) + " bytes", flush=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        faces = Faces(folder)
        subprocess.run(["ogr2ogr", faces.path("points.gpkg"), f"{SURVEY}/points.csv", "-oo", "X_POSSIBLE_NAMES=x", "-oo",
                        "Y_POSSIBLE_NAMES=y", "-oo", "AUTODETECT_TYPE=YES", "-a_srs", "EPSG:32632"], check=True)
        for name, source, options, qgis in BUILDS:
            faces.compare(name, "build", os.path.join(folder, source), options, qgis)
        faces.compare("optimised anew", "optimize", faces.path("survey_command_line.ply"), {"optimize": "edge-length"},
                      ("optimize", {"OPTIMIZE": "edge-length"}))
        print(f"{faces.failed} failed")
        return 1 if faces.failed else 0


if __name__ == "__main__":
    sys.exit(main())
