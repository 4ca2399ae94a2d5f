#!/usr/bin/env python3
"""Simplifies the real DEMs and checks the bound at every cell, with code of its own; prints the table.

Usage: simplify.py BINARY TERRAINS OUTPUT_FOLDER [--plain]

For each DEM and H = 5, 1, 0.5, 0.1 metres, with valley and ridge lines: every valid cell centre lies in the TIN,
which is at most H from the cell's height there (but at vertices of lines, whose height replaces the cell's:
these are conflicts of the report); the largest error and the root mean square are those of the report; all
limits but the last are reached by few vertices. Seconds are of the processor, for the whole run, DEM to PLY, the
proof that the diagonals are best included. --plain adds columns to compare: vertices without lines, and
the root mean square of a regular grid of as many vertices, both of DEMs in metres.
"""
import array
import json
import math
import os
import resource
import subprocess
import sys

from real_terrains import DEMS, read_ply

HEIGHTS = [5, 1, 0.5, 0.1]


def read_dem(path, work):
    raw = f"{work}/dem.raw"
    subprocess.run(["gdal_translate", "-q", "-of", "ENVI", "-ot", "Float64", path, raw], check=True)
    info = json.loads(subprocess.run(["gdalinfo", "-json", path], check=True, capture_output=True).stdout)
    values = array.array("d")
    with open(raw, "rb") as file:
        values.frombytes(file.read())
    columns, rows = info["size"]
    nodata = info["bands"][0].get("noDataValue")
    x0, dx, _, y0, _, dy = info["geoTransform"]
    return values, columns, rows, nodata if nodata is None else float(nodata), x0, dx, y0, dy


def errors_at_cells(dem, vertices, faces):
    """For each valid cell the least error over the triangles that hold its centre, or None outside of all."""
    values, columns, rows, nodata, x0, dx, y0, dy = dem
    errors = [None] * len(values)
    slack = 1e-7
    for corners in faces:
        # In cell coordinates: the centre of column c and row r is (c, r).
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (
            ((x - x0) / dx - 0.5, (y - y0) / dy - 0.5, z) for x, y, z in (vertices[v] for v in corners))
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        top, bottom = math.ceil(min(ay, by, cy) - slack), math.floor(max(ay, by, cy) + slack)
        slope_x = ((bz - az) * (cy - ay) - (by - ay) * (cz - az)) / area
        slope_y = ((bx - ax) * (cz - az) - (bz - az) * (cx - ax)) / area
        for row in range(max(top, 0), min(bottom, rows - 1) + 1):
            left, right = math.inf, -math.inf
            for px, py, qx, qy in ((ax, ay, bx, by), (bx, by, cx, cy), (cx, cy, ax, ay)):
                if py > qy:
                    px, py, qx, qy = qx, qy, px, py
                if not py - slack <= row <= qy + slack:
                    continue
                if qy - py < 2 * slack:
                    left, right = min(left, px, qx), max(right, px, qx)
                    continue
                x = px + (qx - px) * min(1, max(0, (row - py) / (qy - py)))
                left, right = min(left, x), max(right, x)
            if left > right:
                continue
            base = az + slope_y * (row - ay) - slope_x * ax
            for column in range(max(0, math.ceil(left - slack)), min(columns - 1, math.floor(right + slack)) + 1):
                i = row * columns + column
                error = abs(base + slope_x * column - values[i])
                if errors[i] is None or error < errors[i]:
                    errors[i] = error
    return [(i, e) for i, e in enumerate(errors) if values[i] != nodata and values[i] == values[i]]


def replaced_cells(report, dem):
    _, columns, _, _, x0, dx, y0, dy = dem
    cells = set()
    for conflict in report["conflicts"]:
        column, row = (conflict["x"] - x0) / dx - 0.5, (conflict["y"] - y0) / dy - 0.5
        cells.add(round(row) * columns + round(column))
    return cells


def grid_rms(dem, count):
    """Of the bilinear surface through a regular grid of about `count` cell centres over the whole DEM."""
    values, columns, rows, nodata, *_ = dem
    step = math.sqrt((columns - 1) * (rows - 1) / count)
    nx, ny = max(1, round((columns - 1) / step)), max(1, round((rows - 1) / step))
    xs = sorted({round(i * (columns - 1) / nx) for i in range(nx + 1)})
    ys = sorted({round(i * (rows - 1) / ny) for i in range(ny + 1)})
    squares, cells = 0.0, 0
    for y0, y1 in zip(ys, ys[1:]):
        for x0, x1 in zip(xs, xs[1:]):
            corner = [values[y * columns + x] for y in (y0, y1) for x in (x0, x1)]
            if nodata in corner:
                continue
            for y in range(y0, y1):
                v = (y - y0) / (y1 - y0)
                left, right = corner[0] * (1 - v) + corner[2] * v, corner[1] * (1 - v) + corner[3] * v
                for x in range(x0, x1):
                    value = values[y * columns + x]
                    if value != nodata:
                        u = (x - x0) / (x1 - x0)
                        squares += (left * (1 - u) + right * u - value) ** 2
                        cells += 1
    return math.sqrt(squares / max(1, cells))


def build(binary, sources, output, *options):
    """The report, with the processor seconds of the whole run."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([binary, "build", *sources, output, "--overwrite", "-q", "--report", "-", *options],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{output}: {done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    report = json.loads(done.stdout)
    report["processor_s"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return report


def check(name, limit, dem, report, vertices, faces):
    """Longitudes and latitudes bend against the metric plane, in which the errors are those of the bound."""
    faults = []
    bend = 1e-3 if report["crs"]["metric_projection"] else 0
    told = report["simplification"]
    replaced = replaced_cells(report, dem)
    errors = errors_at_cells(dem, vertices, faces)
    outside = [i for i, e in errors if e is None]
    if outside:
        faults.append(f"{len(outside)} cells are outside, the first is {outside[0]}")
    kept = [(i, e) for i, e in errors if e is not None and i not in replaced]
    largest = max(e for _, e in kept)
    if largest > limit + 1e-6 + bend:
        faults.append(f"an error of {largest} m")
    if abs(largest - told["largest_error_m"]["result"]) > 1e-4 + bend and not replaced:
        faults.append(f"the report says {told['largest_error_m']['result']}, found {largest}")
    rms = math.sqrt(sum(e * e for _, e in kept) / len(kept))
    if abs(rms - told["rms_error_m"]["result"]) > 0.02 * rms + 1e-6 + bend:
        faults.append(f"the report says rms {told['rms_error_m']['result']}, found {rms}")
    if told["stopped_by"] != "max-error":
        faults.append(f"stopped by {told['stopped_by']}")
    if not all(c["optimal"] for c in report["criteria"]):
        faults.append("not optimal")
    return [f"{name}, {limit} m: {fault}" for fault in faults], rms


def main():
    binary, root, work = sys.argv[1:4]
    if not os.path.isdir(root):
        print(f"no terrains at {root}; skipped")
        return 77
    os.makedirs(work, exist_ok=True)
    faults = []
    print("| DEM | H, m | vertices | of lines, outline | rms, m | s a million cells |"
          + (" without lines | grid's rms, m |" if "--plain" in sys.argv else ""))
    print("|---|---|---|---|---|---|" + ("---|---|" if "--plain" in sys.argv else ""))
    for name in DEMS:
        folder = f"{root}/{name}"
        lines = ["--valleys", f"{folder}/lines.gpkg|layername=valleys",
                 "--ridges", f"{folder}/lines.gpkg|layername=ridges"]
        dem = read_dem(f"{folder}/dem.tif", work)
        for limit in HEIGHTS:
            output = f"{work}/{name}.ply"
            report = build(binary, [f"{folder}/dem.tif"], output, "--max-error", str(limit), *lines)
            vertices, faces, _ = read_ply(output)
            found, rms = check(name, limit, dem, report, vertices, faces)
            faults += found
            told = report["simplification"]
            seconds = report["processor_s"] / told["source_points"] * 1e6
            row = (f"| {name} | {limit} | {len(vertices)} | {told['fixed_vertices']} | {rms:.3f} | {seconds:.2f} |")
            if "--plain" in sys.argv:
                plain = build(binary, [f"{folder}/dem.tif"], output, "--max-error", str(limit))
                row += f" {plain['tin']['vertices']} | {grid_rms(dem, len(vertices)):.3f} |"
            print(row, flush=True)
    for fault in faults:
        print("FAIL " + fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
