#!/usr/bin/env python3
"""Lets toulbar2 solve dumped problems from real terrains, and compares its optimum with the report's.

Usage: toulbar2_terrains.py BINARY TERRAINS

From three terrains, of which one has breaklines, windows with up to 2000 quadrilaterals. For every criterion that is a
sum over pairs of triangles or over vertices, alone, and for normal-angle-sum with fewest pits, the optimum that
toulbar2 proves is the result to the last step of 2^-32. For those that are the worst of such terms, toulbar2 proves that
every choice has a term that is no better than the result. Prints a table. Without toulbar2 or the terrains: skipped.
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SUMS = ["normal-angle-sum", "normal-angle-squares", "edge-length", "area-ratio-sum", "convex-edges", "convex-vertices",
        "mixed-vertices", "local-minima,normal-angle-sum", "pit-depth,normal-angle-sum"]
WORST = ["normal-angle-max", "area-ratio-max", "max-degree", "local-minima,normal-angle-max"]
MOST_QUADRILATERALS = 2000
WINDOWS = 3


def dem_windows(path, cells):
    """Boxes of so many cells a side along the raster's diagonal, in its coordinates."""
    info = json.loads(subprocess.run(["gdalinfo", "-json", path], capture_output=True, text=True, check=True).stdout)
    x0, dx, _, y0, _, dy = info["geoTransform"]
    columns, rows = info["size"]
    for i in range(WINDOWS):
        column, row = ((i + 1) * columns // (WINDOWS + 2), (i + 1) * rows // (WINDOWS + 2))
        yield (x0 + column * dx, y0 + (row + cells) * dy, x0 + (column + cells) * dx, y0 + row * dy)


def point_windows(path, count):
    """Boxes about points of the file that hold about so many of them."""
    with open(path, newline="") as file:
        points = [(float(r["x"]), float(r["y"])) for r in csv.DictReader(file)]
    for i in range(WINDOWS):
        x, y = sorted(points)[(i + 1) * len(points) // (WINDOWS + 1)]
        reach = sorted(max(abs(p[0] - x), abs(p[1] - y)) for p in points)[count]
        yield (x - reach, y - reach, x + reach, y + reach)


def problems(root):
    for name in ("bigtujunga_srtm30", "vermont_srtm90"):
        dem = root / name / "dem.tif"
        for box in dem_windows(dem, 44):
            yield name, [dem], box
    delft = root / "delft_ahn3_bgt"
    for box in point_windows(delft / "ground_water_points.csv", 1500):
        yield "delft_ahn3_bgt", [delft / "ground_water_points.csv", "--a-crs", "EPSG:28992",
                                 "--breaklines", f"{delft}/bgt.gpkg|layername=breaklines_3d"], box


def check(binary, sources, box, criteria, work):
    command = [binary, "build", *sources, "--bbox", ",".join(repr(c) for c in box), f"{work}/t.ply", "--overwrite", "-q",
               "--optimize", criteria, "--report", f"{work}/r.json", "--dump-problem", f"{work}/p.cfn",
               *(["--effort", "1000000"] if criteria in WORST else [])]  # what follows the worst term is not looked at
    subprocess.run(command, check=True)
    report = json.loads(pathlib.Path(f"{work}/r.json").read_text())
    line, structure = report["criteria"][-1], report["first_order"]
    assert structure["quadrilaterals"] <= MOST_QUADRILATERALS, structure
    started = time.monotonic()
    options = ["-ub=1"] if criteria in WORST else ["-B=1", "-O=-3"]  # is there a choice that costs less than 1?
    output = subprocess.run(["toulbar2", f"{work}/p.cfn", *options], capture_output=True, text=True, timeout=120).stdout
    seconds = time.monotonic() - started
    optimum = next((float(text.split()[1]) for text in output.splitlines() if text.startswith("Optimum: ")), None)
    sign = -1 if line["direction"] == "max" else 1
    same = "No solution" in output if criteria in WORST else optimum == sign * line["result"] * 2**32
    return structure, line, same and line["optimal"], seconds


def main():
    binary, root = sys.argv[1], pathlib.Path(sys.argv[2])
    if not shutil.which("toulbar2") or not shutil.which("gdalinfo") or not root.is_dir():
        print("toulbar2, gdalinfo or the terrains are missing: skipped")
        sys.exit(77)
    print("| terrain | criteria | quadrilaterals | result | toulbar2 | its seconds |\n|---|---|---|---|---|---|")
    failed = 0
    with tempfile.TemporaryDirectory() as work:
        for terrain, sources, box in problems(root):
            for criteria in SUMS + WORST:
                structure, line, same, seconds = check(binary, sources, box, criteria, work)
                failed += not same
                print(f"| {terrain} | {criteria} | {structure['quadrilaterals']} | {line['result']:.10g} "
                      f"| {'DIFFERS' if not same else 'nothing better' if criteria in WORST else 'the same'} | {seconds:.1f} |", flush=True)
    sys.exit(1 if failed else 0)


main()
