#!/usr/bin/env python3
"""The census of orders on growing input: how many useful edges and triangles of order at most k are there a point?

Usage: census.py THALWEG FOLDER [--sizes N[,N...]] [--order K] [--terrain NAME POINTS LINES...]...
Writes FOLDER/census.md (table) and FOLDER/census.svg (plot), anew after each input. Inputs are made here, from fixed
seeds:

  random      uniform points, no constraint edges
  random-5    the same points; constraint edges for 5 % of the edges of a triangulation, drawn at random from the
              edges useful at order 3 without constraints, where they do not cross
  random-20   the same, 20 %
  polylines   points with winding lines through them
  comb        points between parallel constraint edges, each half as long as the square is wide

and real ones where --terrain names them: a source of points, and sources of lines, as `thalweg order` takes them; where
lines cross, the crossing becomes a vertex.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess

SCENES = ("random", "random-5", "random-20", "polylines", "comb")
COLOURS = ("#444444", "#1b9e77", "#66a61e", "#d95f02", "#7570b3", "#e7298a", "#a6761d", "#1f78b4", "#b15928", "#6a3d9a")


def turn(p, q, r):
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def cross(a, b, c, d):
    return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0


def write_points(path, points):
    path.write_text("x,y,z\n" + "".join(f"{x:.6f},{y:.6f},0\n" for x, y in points))


def write_lines(path, lines):
    rows = ["id,WKT\n"]
    for i, line in enumerate(lines):
        rows.append(f'{i},"LINESTRING Z ({",".join(f"{x:.6f} {y:.6f} 0" for x, y in line)})"\n')
    path.write_text("".join(rows))


def scatter(count, seed):
    dice = random.Random(seed)
    return [(round(1000 * dice.random(), 6), round(1000 * dice.random(), 6)) for _ in range(count)]


def chosen_edges(thalweg, folder, points, share, seed):
    """Edges that do not cross, from those useful at order 3 without constraint edges."""
    source, edges = folder / "points.csv", folder / "edges.csv"
    write_points(source, points)
    subprocess.run([thalweg, "order", source, "--order", "3", "--definition", "std", "--list-edges", edges, "-q",
                    "--overwrite"], check=True)
    rows = [tuple(map(int, row.split(",")[:2])) for row in edges.read_text().split()[1:]]
    random.Random(seed).shuffle(rows)
    cell, cells, kept = 1000 * 4 / math.sqrt(len(points)), {}, []
    for a, b in rows:
        if len(kept) >= share * 3 * len(points):
            break
        p, q = points[a], points[b]
        xs = range(int(min(p[0], q[0]) / cell), int(max(p[0], q[0]) / cell) + 1)
        ys = range(int(min(p[1], q[1]) / cell), int(max(p[1], q[1]) / cell) + 1)
        here = [(x, y) for x in xs for y in ys]
        if len(here) > 50 or any(cross(p, q, *other) for c in here for other in cells.get(c, ())):
            continue
        for c in here:
            cells.setdefault(c, []).append((p, q))
        kept.append([p, q])
    return kept


def make(thalweg, folder, scene, count):
    points, lines = scatter(count, count), []
    if scene.startswith("random-"):
        lines = chosen_edges(thalweg, folder, points, int(scene.split("-")[1]) / 100, count)
    elif scene == "polylines":
        step = 1000 / math.sqrt(count)
        lines = [[(i * step, 10 + 20 * j + 8 * math.sin(i * step / 17 + j)) for i in range(int(1000 / step))]
                 for j in range(50)]
    elif scene == "comb":
        teeth, dice = count // 20, random.Random(count)
        points = points[:count - 2 * teeth]
        for i in range(teeth):
            start, y = 400 * dice.random(), 1000 * (i + 0.5) / teeth
            lines.append([(start, y), (start + 500, y)])
    write_points(folder / "points.csv", points)
    write_lines(folder / "lines.csv", lines)
    return bool(lines)


def count_orders(thalweg, points, lines, order):
    command = [thalweg, "order", points, "--census", "--order", str(order), "-q", "-f", "json", "--crossing", "mean"]
    for source in lines:
        command += ["--breaklines", source]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def take(thalweg, folder, scene, count, order):
    has_lines = make(thalweg, folder, scene, count)
    return count_orders(thalweg, folder / "points.csv", [folder / "lines.csv"] if has_lines else [], order)


def table(results, order):
    lines = ["| input | vertices | definition | " +
             " | ".join(f"edges a point, k = {k}" for k in range(order + 1)) + " | unknown | " +
             " | ".join(f"triangles a point, k = {k}" for k in range(order + 1)) + " |",
             "|---" * (2 * order + 6) + "|"]
    for scene, result in sorted(results, key=lambda item: (*SCENES, item[0]).index(item[0])):
        names = []
        for row in result["census"]:
            if row["definition"] not in names:
                names.append(row["definition"])
        for name in names:
            rows = [row for row in result["census"] if row["definition"] == name]
            lines.append(f"| {scene} | {result['vertices']} | {name} | " +
                         " | ".join(f"{row['edges_per_point']:.3f}" for row in rows) +
                         f" | {rows[-1]['unknown_edges']} | " +
                         " | ".join(f"{row['triangles_per_point']:.2f}" for row in rows) + " |")
    return "\n".join(lines) + "\n"


def plot(results, order, definition="sees-opp"):
    """Useful edges a point against the number of points (logarithmic); a curve for each k, dashed by k."""
    curves, scenes = {}, list(dict.fromkeys(scene for scene, _ in results))
    for scene, result in results:
        for row in result["census"]:
            if row["definition"] == definition:
                curves.setdefault((scene, row["order"]), []).append((result["vertices"], row["edges_per_point"]))
    sizes = [n for curve in curves.values() for n, _ in curve]
    highest = max(value for curve in curves.values() for _, value in curve) * 1.05
    low, high = math.log10(min(sizes)), math.log10(max(sizes)) + 1e-9
    width, height, left, top = 760, 420, 60, 30
    at_x = lambda n: left + (math.log10(n) - low) / (high - low) * (width - 200)
    at_y = lambda v: top + (1 - v / highest) * (height - 80)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
             f'font-size="12"><rect width="100%" height="100%" fill="white"/>',
             f'<text x="{left}" y="18">useful edges a point under {definition}, orders at most k</text>']
    for v in range(0, int(highest) + 1):
        parts.append(f'<path d="M{left} {at_y(v):.1f}H{width - 140}" stroke="#ddd"/>'
                     f'<text x="{left - 20}" y="{at_y(v) + 4:.1f}">{v}</text>')
    for n in sorted({10 ** i for i in range(1, 8)}):
        if 10 ** low * 0.99 <= n <= 10 ** high * 1.01:
            parts.append(f'<text x="{at_x(n) - 15:.1f}" y="{height - 25}">{n}</text>')
    for (scene, k), curve in sorted(curves.items()):
        path = "L".join(f"{at_x(n):.1f} {at_y(v):.1f}" for n, v in sorted(curve))
        dash = ["none", "8 3", "4 3", "1 3", "8 3 1 3"][k % 5]
        colour = COLOURS[scenes.index(scene) % len(COLOURS)]
        parts.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="1.5" stroke-dasharray="{dash}"/>')
        if len(curve) == 1:
            parts.append(f'<circle cx="{at_x(curve[0][0]):.1f}" cy="{at_y(curve[0][1]):.1f}" r="3" fill="{colour}"/>')
    for i, scene in enumerate(scenes):
        parts.append(f'<text x="{width - 120}" y="{60 + 18 * i}" fill="{COLOURS[i % len(COLOURS)]}">{scene}</text>')
    below = 80 + 18 * len(scenes)
    for k in range(order + 1):
        dash = ["none", "8 3", "4 3", "1 3", "8 3 1 3"][k % 5]
        parts.append(f'<path d="M{width - 120} {below + 18 * k}h40" stroke="black" stroke-dasharray="{dash}"/>'
                     f'<text x="{width - 70}" y="{below + 4 + 18 * k}">k = {k}</text>')
    parts.append(f'<text x="{left + 200}" y="{height - 6}">vertices</text></svg>')
    return "\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("thalweg")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--sizes", default="1000,3000,10000")
    parser.add_argument("--order", type=int, default=3)
    parser.add_argument("--terrain", nargs="+", action="append", default=[], metavar="NAME POINTS LINES")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    results = []

    def add(name, result):
        results.append((name, result))
        (options.folder / "census.md").write_text(table(results, options.order))
        (options.folder / "census.svg").write_text(plot(results, options.order))
        print(name, result["vertices"], "done", flush=True)

    for name, points, *lines in options.terrain:
        add(name, count_orders(options.thalweg, points, lines, options.order))
    for count in map(int, options.sizes.split(",")):
        for scene in SCENES:
            add(scene, take(options.thalweg, options.folder, scene, count, options.order))


if __name__ == "__main__":
    main()
