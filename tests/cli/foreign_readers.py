#!/usr/bin/env python3
"""Opens every format that a TIN is written in with a program that is not ours, and compares the counts; then reads
back those that Thalweg reads.

A reader that is not installed is named, and its formats are left out.
Usage: foreign_readers.py BINARY SOURCE
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

MESHIO = ("import meshio, sys; m = meshio.read(sys.argv[1]); "
          "print(len(m.points), sum(len(c.data) for c in m.cells if c.type == 'triangle'))")
VTK = """
import sys
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
types = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
print(grid.GetNumberOfPoints(), types.count(5), types.count(3) > 0, reader.GetErrorCode())
"""
MDAL = """
import sys
from qgis.core import QgsApplication, QgsMeshLayer
app = QgsApplication([], False)
app.initQgis()
layer = QgsMeshLayer(sys.argv[1], 'tin', 'mdal')
provider = layer.dataProvider()
print(provider.vertexCount(), provider.faceCount(), layer.crs().authid())
app.exitQgis()
"""
TESTS = os.path.dirname(os.path.abspath(__file__))
PYTHON = "/usr/bin/python3"  # the one that Debian's python3-* packages are for


def run(*command):
    env = dict(os.environ, QT_QPA_PLATFORM="offscreen", LC_ALL="C.UTF-8")
    done = subprocess.run(command, capture_output=True, text=True, env=env, timeout=100)
    return done.stdout + done.stderr


def imports(module):
    return os.path.exists(PYTHON) and subprocess.run([PYTHON, "-c", f"import {module}"],
                                                     capture_output=True).returncode == 0


def ogr(path, vertices, triangles):
    text = run("ogrinfo", "-ro", "-so", "-al", path)
    return (f"Feature Count: {triangles}" in text and "3D Polygon" in text and '"EPSG",32632' in text), text


def assimp(path, vertices, triangles):
    text = run("assimp", "info", path)
    return re.search(rf"^Faces: +{triangles}$|/ {triangles} \| triangle", text, re.M) is not None, text


def meshio(path, vertices, triangles):
    text = run(PYTHON, "-c", MESHIO, path)
    return text.split()[-2:] == [str(vertices), str(triangles)], text


def vtk(path, vertices, triangles):
    text = run(PYTHON, "-c", VTK, path)
    return f"{vertices} {triangles} True 0" in text, text


def mdal(path, vertices, triangles):
    text = run(PYTHON, "-c", MDAL, path)
    crs = "" if path.endswith(".2dm") else " EPSG:32632"
    return f"{vertices} {triangles}{crs}" in text, text


def ncdump(path, vertices, triangles):
    text = run("ncdump", "-h", path)
    return f"nMesh2_node = {vertices} ;" in text and f"nMesh2_face = {triangles} ;" in text, text


def xmllint(path, vertices, triangles):
    """Against a schema of our own, written after the standard's description: LandXML's is in no package."""
    schema = os.path.join(os.path.dirname(TESTS), "support", "landxml_surface.rng")
    valid = run("xmllint", "--noout", "--relaxng", schema, path)
    count = run("xmllint", "--xpath", "concat(count(//*[local-name()='P']), ' ', count(//*[local-name()='F']))", path)
    return valid.strip() == f"{path} validates" and count.split() == [str(vertices), str(triangles)], valid + count


def read_back(binary, work):
    """Each format that Thalweg reads too gives back what was written, by `info`. Returns (tried, failed)."""
    def facts(path):
        told = json.loads(run(binary, "info", path, "-f", "json"))
        return {key: told[key] for key in ("digest", "crs", "vertices", "triangles", "constraint_edges")}

    given = facts("tin.ply")
    formats = [f for f in json.loads(run(binary, "formats", "-f", "json"))["tin"] if f["reads"] and f["writes"]]
    failed = 0
    for format_ in formats:
        extension = format_["extensions"][0]
        os.makedirs("back")
        path = os.path.join(work, "back", "tin" + extension)
        said = run(binary, "convert", "tin.ply", path, "-q")
        told, expected = facts(path), dict(given)
        if format_["name"] in ("OFF", "STL"):  # which hold faces alone
            expected.update(constraint_edges=0, digest=told["digest"])
        shutil.rmtree("back")
        failed += told != expected
        print(f"{'ok  ' if told == expected else 'FAIL'} Thalweg {extension}"
              + ("" if told == expected else f": {told}, expected {expected} {said}"))
    return len(formats), failed


READERS = [
    ("GDAL", lambda: shutil.which("ogrinfo"), ogr, [".gpkg", ".fgb", ".shp", ".geojson"]),
    ("assimp", lambda: shutil.which("assimp"), assimp, [".glb", ".stl", ".off", ".obj"]),
    ("meshio", lambda: imports("meshio"), meshio, [".vtu", ".stl", ".off", ".obj"]),
    ("VTK", lambda: imports("vtkmodules.vtkIOXML"), vtk, [".vtu"]),
    ("ncdump", lambda: shutil.which("ncdump"), ncdump, [".nc"]),
    ("xmllint", lambda: shutil.which("xmllint"), xmllint, [".xml"]),
    ("QGIS (MDAL)", lambda: imports("qgis.core"), mdal, [".ply", ".2dm", ".nc"]),
]


def main():
    binary, source = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        survey = f"{source}/sample_terrains/survey"
        run(binary, "build", f"{survey}/points.csv", "tin.ply", "-q", "--a-crs", "EPSG:32632", "--order", "0",
            "--valleys", f"{survey}/lines.gpkg|layername=valleys")
        info = run(binary, "info", "tin.ply")
        vertices, triangles = (int(re.search(rf"^{word} +(\d+)$", info, re.M).group(1))
                               for word in ("vertices", "triangles"))
        tried, failed = read_back(binary, work)
        for name, is_there, read, extensions in READERS:
            if not is_there():
                print(f"skip {name} is not installed: {' '.join(extensions)} not opened by it")
                continue
            for extension in extensions:
                os.makedirs(name, exist_ok=True)
                path = os.path.join(work, name, "tin" + extension)
                said = run(binary, "optimize", "--order", "0", "--optimize", "none", "tin.ply", path, "-q")
                right, text = read(path, vertices, triangles)
                shutil.rmtree(name)
                tried += 1
                failed += not right
                print(f"{'ok  ' if right else 'FAIL'} {name} {extension}" + ("" if right else f": {said}{text[-600:]}"))
    print(f"{tried - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
