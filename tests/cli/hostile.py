#!/usr/bin/env python3
"""Inputs that are made to hurt: each gets a right answer or one ERROR line, in bounded time and memory.

What is built is checked by build itself; where it is small, by `thalweg verify` too. Prints a table: input, answer, seconds of processor time, memory.
Usage: hostile.py BINARY [--heavy] [CASE...]; --heavy takes the sizes that hurt (minutes, some GiB).
"""
import json
import math
import os
import pathlib
import random
import re
import resource
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time

HEAVY = "--heavy" in sys.argv
ALLOWANCE = int(os.environ.get("THALWEG_ALLOWANCE", 1))  # how many times as much a slower build may take
SECONDS = ALLOWANCE * (1200 if HEAVY else 60)     # of processor time
MEBIBYTES = ALLOWANCE * (6000 if HEAVY else 700)  # of memory


def size(quick, heavy):
    return heavy if HEAVY else quick


def points(rows):
    pathlib.Path("p.csv").write_text("x,y,z\n" + "".join(f"{x!r},{y!r},{z!r}\n" for x, y, z in rows))
    return ["p.csv"]


def lines(parts, name="l.geojson"):
    features = ",".join('{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[%s]}}' %
                        ",".join("[%s]" % ",".join(map(repr, place)) for place in part) for part in parts)
    pathlib.Path(name).write_text('{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":'
                                  '"urn:ogc:def:crs:EPSG::32632"}},"features":[%s]}' % features)
    return ["--breaklines", name]


def square(side=1000.0, count=400):
    random.seed(3)
    return [(random.uniform(0, side), random.uniform(0, side), float(i % 9)) for i in range(count)]


# --- coordinates

def not_numbers():
    return points([(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (math.nan, 1.0, 1.0)]), "bad-coordinate"


def infinite():
    return points([(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.0, math.inf, 1.0)]), "bad-coordinate"


def huge():
    return points([(0.0, 0.0, 1.0), (1e300, 0.0, 1.0), (0.0, 1e300, 1.0)]), "bad-coordinate"


def huge_heights():
    return points([(0.0, 0.0, 1e300), (1.0, 0.0, -1e300), (0.0, 1.0, 0.0)]), "bad-coordinate"


def denormals():
    return points([(i * 5e-324, j * 5e-324, float(i ^ j)) for i in range(9) for j in range(9)]), "built or too-close"


def fine_spacing():
    n = size(60, 1000)
    return points([(1e7 + i * 1e-9, 1e7 + j * 1e-9, float(i ^ j)) for i in range(n) for j in range(n)]), "built or collinear"


def identical():
    return points([(5.0, 5.0, 1.0)] * size(100000, 1000000)), "too-few-points"


def identical_and_others():
    return points([(5.0, 5.0, 1.0)] * size(100000, 1000000) + square()), "built"


def collinear():
    return points([(float(i), 2.0 * i, 1.0) for i in range(size(100000, 3000000))]), "collinear"


def collinear_and_one():
    n = size(20000, 2000000)
    return points([(float(i), 2.0 * i, float(i % 7)) for i in range(n)] + [(0.0, float(n), 1.0)]), "built"


def cocircular():
    n = size(20000, 500000)
    return points([(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), float(i % 5)) for i in range(n)]), "built"


# --- lines

def star():
    """Lines that all cross in one point."""
    n = size(2000, 100000)
    ends = [(math.cos(math.pi * i / n), math.sin(math.pi * i / n)) for i in range(n)]
    parts = [((1000 * x, 1000 * y, 1.0), (-1000 * x, -1000 * y, 1.0)) for x, y in ends]
    return points([(-2000.0, -2000.0, 1.0), (2000.0, -2000.0, 1.0), (0.0, 2000.0, 2.0)]) + lines(parts), "size-limit" if HEAVY else "built"


def grid_of_lines():
    """Each of half the lines crosses each of the others."""
    n = size(150, 1500)
    parts = [((float(i), -1.0, 1.0), (float(i), n + 1.0, 1.0)) for i in range(n)]
    parts += [((-1.0, float(i), 1.0), (n + 1.0, float(i), 1.0)) for i in range(n)]
    return points(square(float(n))) + lines(parts), "built"


def spiral():
    n = size(5000, 100000)
    part = [(math.sqrt(i) * math.cos(math.sqrt(i)), math.sqrt(i) * math.sin(math.sqrt(i)), float(i % 9))
            for i in range(n)]
    return points(square(50.0)) + lines([part]), "built"


def comb():
    """Long thin teeth side by side."""
    n = size(1500, 50000)
    part = [(i * 1e-3, (0.0, 1000.0, 1000.0, 0.0)[i % 4], float(i % 3)) for i in range(n)]
    return points(square(100.0)) + lines([part]), "built"


def fan():
    """Edges from one vertex to many."""
    n = size(2000, 100000)
    parts = [((0.0, 0.0, 1.0), (1000.0, i / n, 2.0)) for i in range(n)]
    return points(square()) + lines(parts), "built"


def overlapping():
    """Lines that all lie on one another."""
    n = size(1500, 20000)
    parts = [((float(-i), 0.0, 1.0), (float(n + i), 0.0, 1.0)) for i in range(n)]
    return points([(-9e4, -9e4, 1.0), (9e4, -9e4, 1.0), (0.0, 9e4, 2.0)]) + lines(parts), "size-limit" if HEAVY else "built"


# --- files that lie about counts

def whole(extension):
    points([(float(i % 7), float(i // 7), float(i % 5)) for i in range(49)])
    subprocess.run([BINARY, "build", "p.csv", "w" + extension, "-q", "--overwrite"], check=True)
    return pathlib.Path("w" + extension).read_bytes()


def liar(extension, change):
    def make():
        pathlib.Path("liar" + extension).write_bytes(change(whole(extension)))
        return ["liar" + extension], "bad-format"
    return make


def replaced(pattern, by):
    return lambda data: re.sub(pattern, by, data, count=1)


def patched(at, value):
    return lambda data: data[:at] + value + data[at + len(value):]


def las():
    head = bytearray(227)
    head[:4], head[24:26] = b"LASF", bytes((1, 2))
    struct.pack_into("<HIIBHI", head, 94, 227, 227, 0, 0, 20, 4000000000)
    struct.pack_into("<6d", head, 131, .01, .01, .01, 0, 0, 0)
    pathlib.Path("liar.las").write_bytes(bytes(head) + bytes(20) * 5)
    return ["liar.las"], "bad-format"


def netcdf():
    data = whole(".nc")
    at = data.index(struct.pack(">I", 49))  # the length of the dimension of nodes
    pathlib.Path("liar.nc").write_bytes(data[:at] + struct.pack(">I", 0x7ffffff0) + data[at + 4:])
    return ["liar.nc"], "bad-format or unreadable or unsupported"


def netcdf_cut():
    pathlib.Path("liar.nc").write_bytes(whole(".nc")[:-20])
    return ["liar.nc"], "bad-format"


def netcdf_for_gdal():
    pathlib.Path("cut.grd").write_bytes(whole(".nc")[:-20])
    return ["cut.grd"], "bad-format"


def geopackage():
    pathlib.Path("liar.gpkg").write_bytes(whole(".gpkg"))
    with sqlite3.connect("liar.gpkg") as base:
        for (trigger,) in base.execute("select name from sqlite_master where type='trigger'").fetchall():
            base.execute(f'drop trigger "{trigger}"')
        base.execute('update vertices set id = 4000000000 where fid = 3')
    return ["liar.gpkg"], "built"  # ids only sort the vertices; corners are found by position


CASES = {
    "no number": not_numbers, "infinite": infinite, "1e300": huge, "heights of 1e300": huge_heights,
    "denormals": denormals, "1e-9 apart at 1e7": fine_spacing, "identical points": identical,
    "identical and others": identical_and_others, "collinear points": collinear,
    "collinear and one beside": collinear_and_one, "cocircular points": cocircular,
    "lines cross in one point": star, "lines cross each other": grid_of_lines, "spiral": spiral, "comb": comb,
    "fan of lines": fan, "lines on one another": overlapping,
    "PLY: vertices": liar(".ply", replaced(rb"element vertex \d+", b"element vertex 4000000000")),
    "PLY: faces": liar(".ply", replaced(rb"element face \d+", b"element face 4000000000")),
    "OBJ: corner": liar(".obj", replaced(rb"\nf \d+", b"\nf 4000000000")),
    "2DM: corner": liar(".2dm", replaced(rb"E3T 1 \d+", b"E3T 1 4000000000")),
    "OFF: vertices": liar(".off", replaced(rb"OFF\n\d+", b"OFF\n4000000000")),
    "OFF: faces": liar(".off", replaced(rb"OFF\n(\d+) \d+", rb"OFF\n\1 4000000000")),
    "STL: triangles": liar(".stl", patched(80, struct.pack("<I", 4000000000))),
    "LandXML: corner": liar(".xml", replaced(rb"(<F[^>]*>)\d+", rb"\g<1>4000000000")),
    "LAS: points": las, "UGRID: nodes": netcdf, "UGRID: cut off": netcdf_cut, "NetCDF for GDAL: cut off": netcdf_for_gdal,
    "GPKG: corner": geopackage,
}


def limit():
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 5))


def measured(arguments):
    """Runs the command; its status, last line of errors, processor seconds and MiB."""
    with open("err", "wb") as err:
        child = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=err, preexec_fn=limit)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    return (child.returncode, pathlib.Path("err").read_text(errors="replace"), usage.ru_utime + usage.ru_stime,
            usage.ru_maxrss / 1024)


def run(name):
    inputs, expected = CASES[name]()
    mesh = inputs[0].startswith("liar") and not inputs[0].endswith(".las")
    command = ["convert", inputs[0].split("|")[0], "out.obj"] if mesh else ["build", *inputs, "out.ply", "--report", "r.json"]
    status, err, seconds, memory = measured([BINARY, *command, "-q"])
    found = re.fullmatch(r"ERROR ([a-z-]+): .+\n", err)
    answer = "built" if status == 0 else found.group(1) if status == 1 and found else f"status {status}: {err.strip()[:200]}"
    good = answer in expected.split(" or ") and seconds < SECONDS and memory < MEBIBYTES
    # The plain code of verify takes the square of the time.
    if status == 0 and not mesh and json.loads(pathlib.Path("r.json").read_text())["tin"]["vertices"] < 3000:
        checked = measured([BINARY, "verify", "out.ply", "--report", "r.json", "-q"])
        if checked[0] != 0:
            answer, good = f"built, but {checked[1].strip()[:200]}", False
    print(f"{'ok  ' if good else 'FAIL'} {name:<26} {answer:<16} {seconds:>8.2f} s {memory:>7.0f} MiB"
          + ("" if good else f"   expected {expected}"), flush=True)
    return good


def main():
    names = [a for a in sys.argv[2:] if not a.startswith("--")] or list(CASES)
    failed = 0
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            failed += not run(name)
            os.chdir("/")
    print(f"{len(names) - failed} passed, {failed} failed")
    return 1 if failed else 0


BINARY = os.path.abspath(sys.argv[1])
if __name__ == "__main__":
    sys.exit(main())
