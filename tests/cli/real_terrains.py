#!/usr/bin/env python3
"""Runs the main job on the real terrains and checks what the results claim, with code of its own.

Usage: real_terrains.py BINARY TERRAINS OUTPUT_FOLDER [NAME...]

For each terrain: status 0; both criteria optimal; `thalweg info` finds no violation; the pits and the sum of
normal angles, computed here from the mesh alone, are those of the report; no more pits than the Delaunay TIN;
each bound equals its result; one and two threads give the same bytes, at order 1 and, of what is not too
large, at order 2 and in drainage. Prints a table. Without the terrains it says so and passes.
"""
import filecmp
import json
import math
import os
import struct
import subprocess
import sys

MOST_POINTS_AGAIN = 20_000
DEMS = ["bigtujunga_srtm30", "jacksboro_lonlat", "slovenia_lidar1m", "tidal_marsh_nodata", "vermont_srtm90"]


def commands(root):
    for name in DEMS:
        folder = f"{root}/{name}"
        lines = ["--valleys", f"{folder}/lines.gpkg|layername=valleys_3d",
                 "--ridges", f"{folder}/lines.gpkg|layername=ridges_3d"]
        yield name, [f"{folder}/dem.tif", *lines]
        for sample in ("offgrid", "random", "significant"):
            yield f"{name}:{sample}", [f"{folder}/points_{sample}.csv", *lines]
    yield "slovenia_nan_holes", [f"{root}/slovenia_lidar1m/dem_nan_holes.tif"]
    delft = f"{root}/delft_ahn3_bgt"
    yield "delft:3d", [f"{delft}/ground_water_points.csv", "--a-crs", "EPSG:28992",
                       "--breaklines", f"{delft}/bgt.gpkg|layername=breaklines_3d"]
    staffs = f"{root}/staffordshire_sk00_contours"
    yield "staffordshire", [f"{staffs}/contours.gpkg|layername=spot_heights",
                            "--breaklines", f"{staffs}/contours.gpkg|layername=contours_3d"]
    yield "autzen:ground", [f"{root}/autzen_lidar_feet/ground_points.csv", "--a-crs", "EPSG:2994"]
    yield "autzen:all", [f"{root}/autzen_lidar_feet/all_points.csv", "--a-crs", "EPSG:2994"]
    yield "baja", [f"{root}/baja_ship_tracks_lonlat/soundings.csv", "--a-crs", "EPSG:4326"]


def read_ply(path):
    with open(path, "rb") as file:
        counts = []
        while True:
            line = file.readline().split()
            if line[:1] == [b"element"]:
                counts.append(int(line[2]))
            if line == [b"end_header"]:
                break
        vertices = [struct.unpack("<3d", file.read(24)) for _ in range(counts[0])]
        faces = [struct.unpack("<B3ii", file.read(17))[1:4] for _ in range(counts[1])]
        edges = [struct.unpack("<2iB", file.read(9)) for _ in range(counts[2])] if len(counts) > 2 else []
    return vertices, faces, edges


def count_pits(vertices, faces):
    neighbours = [set() for _ in vertices]
    sides = {}
    for a, b, c in faces:
        for p, q in ((a, b), (b, c), (c, a)):
            neighbours[p].add(q)
            neighbours[q].add(p)
            sides[min(p, q), max(p, q)] = sides.get((min(p, q), max(p, q)), 0) + 1
    rim = {v for edge, n in sides.items() if n == 1 for v in edge}
    seen, pits = [False] * len(vertices), 0
    for start in range(len(vertices)):
        if seen[start] or not neighbours[start]:
            continue
        seen[start] = True
        stack, z, pit = [start], vertices[start][2], True
        while stack:
            v = stack.pop()
            pit = pit and v not in rim
            for n in neighbours[v]:
                if vertices[n][2] < z:
                    pit = False
                elif vertices[n][2] == z and not seen[n]:
                    seen[n] = True
                    stack.append(n)
        pits += pit
    return pits, {e for e in sides}


def angle_sum(vertices, faces, horizontal, vertical):
    normals, sides, total = [], {}, 0.0
    for index, (a, b, c) in enumerate(faces):
        p, q, r = vertices[a], vertices[b], vertices[c]
        u = [(q[0] - p[0]) * horizontal, (q[1] - p[1]) * horizontal, (q[2] - p[2]) * vertical]
        v = [(r[0] - p[0]) * horizontal, (r[1] - p[1]) * horizontal, (r[2] - p[2]) * vertical]
        normals.append((u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]))
        for s, t in ((a, b), (b, c), (c, a)):
            sides.setdefault((min(s, t), max(s, t)), []).append(index)
    for pair in sides.values():
        if len(pair) == 2:
            m, n = normals[pair[0]], normals[pair[1]]
            cross = (m[1] * n[2] - m[2] * n[1], m[2] * n[0] - m[0] * n[2], m[0] * n[1] - m[1] * n[0])
            total += math.atan2(math.hypot(*cross), m[0] * n[0] + m[1] * n[1] + m[2] * n[2])
    return total


def check(binary, report, mesh):
    faults = []
    info = json.loads(subprocess.run([binary, "info", mesh, "-f", "json"], capture_output=True, check=True).stdout)
    if not info["valid"]:
        faults.append(f"violations: {info['violations'][:2]}")
    vertices, faces, edges = read_ply(mesh)
    pits, all_edges = count_pits(vertices, faces)
    if pits != report["pits"]["result"]["interior"]:
        faults.append(f"{pits} pits in the mesh")
    if len(edges) != report["tin"]["constraint_edges"]:
        faults.append(f"{len(edges)} constraint edges in the mesh")
    if any((min(a, b), max(a, b)) not in all_edges for a, b, _ in edges):
        faults.append("a constraint edge is no edge of the mesh")
    for criterion in report["criteria"]:
        if not criterion["optimal"] or criterion["bound"] != criterion["result"]:
            faults.append(f"{criterion['name']} is not proved optimal")
    if report["pits"]["result"]["interior"] > report["pits"]["delaunay"]["interior"]:
        faults.append("more pits than the Delaunay TIN")
    if not report["crs"]["metric_projection"]:
        crs = report["crs"]
        total = angle_sum(vertices, faces, crs["horizontal_metres_per_unit"], crs["vertical_metres_per_unit"])
        if abs(total - report["criteria"][1]["result"]) > 1e-4:
            faults.append(f"normal-angle-sum is {total} in the mesh")
    return faults


def threads_agree(binary, arguments, base, points):
    """What differs between one thread and two."""
    jobs = {"the main job": (["build", *arguments], ".ply")}
    if points <= MOST_POINTS_AGAIN:
        jobs["order 2"] = (["build", *arguments, "--order", "2"], ".ply")
        jobs["drainage"] = (["drain", base + ".ply", base + ".gpkg", "--mesh"], ".nc")
    faults = []
    for job, (command, extension) in jobs.items():
        meshes = [f"{base}_{threads}{extension}" for threads in (1, 2)]
        for threads, mesh in enumerate(meshes, 1):
            done = subprocess.run([binary, *command, mesh, "--threads", str(threads), "--overwrite", "-q"],
                                  capture_output=True)
            if done.returncode:
                return [f"{job} with {threads} threads: {done.stderr.decode().strip()}"]
        if not filecmp.cmp(*meshes, shallow=False):
            faults.append(f"{job}: one thread and two give other bytes")
        for mesh in meshes:
            os.remove(mesh)
    return faults


def main():
    binary, root, out = sys.argv[1:4]
    if not os.path.isdir(root):
        print(f"the real terrains are absent ({root}): nothing was checked")
        return 0
    os.makedirs(out, exist_ok=True)
    print(f"{'terrain':<30}{'points':>8}{'lines':>7}{'pits DT':>8}{'result':>8}{'angle sum DT':>14}{'result':>13}"
          f"{'bound':>13}{'quads':>8}{'fixed':>8}{'pieces':>7}{'largest':>8}{'width':>6}{'s':>7}")
    failed = 0
    for name, arguments in commands(root):
        if sys.argv[4:] and name not in sys.argv[4:]:
            continue
        base = f"{out}/{name.replace(':', '_')}"
        done = subprocess.run([binary, "build", *arguments, base + ".ply", "--report", base + ".json", "--picture",
                               base + ".png", "--overwrite", "-q"], capture_output=True)
        if done.returncode:
            faults = [done.stderr.decode().strip()]
        else:
            with open(base + ".json") as file:
                r = json.load(file)
            pits, angle, first = r["pits"], r["criteria"][1], r["first_order"]
            print(f"{name:<30}{r['input']['points_used']:>8}{r['input']['breaklines_read']:>7}"
                  f"{pits['delaunay']['interior']:>8}{pits['result']['interior']:>8}{angle['delaunay']:>14.4f}"
                  f"{angle['result']:>13.4f}{angle['bound']:>13.4f}{first['quadrilaterals']:>8}"
                  f"{first['fixed_by_elimination']:>8}{first['pieces']:>7}{first['largest_piece']:>8}"
                  f"{first['width']:>6}{r['timings_s']['total']:>7.2f}")
            print(f"{'':<30}smallest angles, 10 degree bins: Delaunay {r['tin']['angle_histogram_delaunay']} "
                  f"result {r['tin']['angle_histogram']}")
            faults = check(binary, r, base + ".ply")
            faults += threads_agree(binary, arguments, base, r["input"]["points_used"])
        failed += bool(faults)
        for fault in faults:
            print(f"FAIL {name}: {fault}")
        sys.stdout.flush()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
