#!/usr/bin/env python3
"""Results do not depend on the order of the input, on an exact translation, or on the number of threads.

Usage: invariance.py BINARY [SEEDS]. Scenes: random points, and lattices with integer heights (plateaus, every
cell cocircular), with a valley and a ridge; coordinates are multiples of 2^-10. Compared are the triangles by the
coordinates of their corners; between thread counts the bytes of the mesh.
"""
import os
import random
import subprocess
import sys
import tempfile

from real_terrains import read_ply

SHIFT = (524288, 4194304)


def scene(rng, lattice):
    if lattice:
        points = [(i * 10.0, j * 10.0, float(rng.randrange(6))) for i in range(14) for j in range(14)]
    else:
        places = {(rng.randrange(1 << 18) / 1024, rng.randrange(1 << 18) / 1024) for _ in range(300)}
        points = [(x, y, rng.randrange(1 << 12) / 64) for x, y in sorted(places)]
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    rng.shuffle(points)

    def place():
        return (min(xs) + (max(xs) - min(xs)) * rng.randrange(64) / 64,
                min(ys) + (max(ys) - min(ys)) * rng.randrange(64) / 64)

    # One straight line, which crosses no other: a crossing is rounded to a grid that depends on the coordinates.
    return points, [(*place(), 1.0), (*place(), 1.0)]


def write(folder, points, line, shift=(0, 0)):
    with open(f"{folder}/p.csv", "w") as file:
        file.write("x,y,z\n")
        for x, y, z in points:
            file.write(f"{x + shift[0]!r},{y + shift[1]!r},{z!r}\n")
    coordinates = ",".join(f"[{x + shift[0]!r},{y + shift[1]!r},{z!r}]" for x, y, z in line)
    with open(f"{folder}/v.geojson", "w") as file:
        file.write('{"type":"FeatureCollection","crs":null,"features":[{"type":"Feature","properties":{},'
                   f'"geometry":{{"type":"LineString","coordinates":[{coordinates}]}}}}]}}')


def run(binary, folder, *options):
    out = f"{folder}/out.ply"
    done = subprocess.run([binary, "build", f"{folder}/p.csv", out, "--valleys", f"{folder}/v.geojson", "--a-crs",
                           "EPSG:32632", "--overwrite", "-q", *options], capture_output=True)
    if done.returncode:
        raise SystemExit(done.stderr.decode())
    with open(out, "rb") as file:
        data = file.read()
    vertices, faces, _ = read_ply(out)
    return data, vertices, faces


def triangles(vertices, faces, shift=(0, 0)):
    moved = [(x - shift[0], y - shift[1], z) for x, y, z in vertices]
    return sorted(tuple(sorted(moved[v] for v in face)) for face in faces)


def main():
    binary, seeds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 12
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(seeds):
            rng = random.Random(f"invariance {seed}")
            points, line = scene(rng, lattice=seed % 2 == 1)
            write(folder, points, line)
            data, vertices, faces = run(binary, folder, "--threads", "1")
            expected = triangles(vertices, faces)
            faults = []
            if run(binary, folder, "--threads", "2")[0] != data:
                faults.append("two threads give other bytes")
            write(folder, points, line, SHIFT)
            _, vertices, faces = run(binary, folder)
            if triangles(vertices, faces, SHIFT) != expected:
                faults.append("translated input gives other triangles")
            write(folder, rng.sample(points, len(points)), line[::-1])
            _, vertices, faces = run(binary, folder)
            if triangles(vertices, faces) != expected:
                faults.append("shuffled input gives other triangles")
            failed += bool(faults)
            for fault in faults:
                print(f"FAIL seed {seed}: {fault}")
    print(f"{seeds - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
