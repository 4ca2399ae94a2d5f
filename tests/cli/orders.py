#!/usr/bin/env python3
"""`thalweg order` against exact_orders.py, on scenes made to be degenerate.

Usage: orders.py BINARY [SCENES [FIRST]]. Points on small lattices, on circles and their tangents, on few lines, or
anywhere; constraint edges wherever they fit, or a ground with holes, necks and pieces that touch in a vertex, by
--boundary and --holes. Compared are the faults and all orders of all triangles, and, under one definition and order a scene, the
lists of triangles, useful edges, conflicts and quadrilaterals, by enumeration of all triangulations.
"""
import csv
import json
import random
import subprocess
import sys
import tempfile
from functools import cmp_to_key
from itertools import combinations
from math import gcd
from pathlib import Path

from exact_orders import DEFINITIONS, Scene, dot, doubled_area, inside_rings, middle, on_segment, orientation

CIRCLES = [[(x, y) for x in range(-19, 20) for y in range(-19, 20) if x * x + y * y == square]
           for square in (25, 50, 65, 85, 325)]


def draw_points(dice, count):
    kind = dice.choice(("lattice", "lattice", "lattice", "circle", "circle", "lines", "any"))
    points = set()
    if kind == "lattice":
        width, height = dice.choice(((5, 5), (5, 5), (3, 3), (4, 2), (6, 3), (2, 5), (8, 8)))
        cells = [(x, y) for x in range(width + 1) for y in range(height + 1)]
        points.update(dice.sample(cells, min(count, len(cells))))
    elif kind == "circle":
        circle = dice.choice(CIRCLES)
        radius = max(x for x, _ in circle)
        points.update(dice.sample(circle, min(len(circle), dice.randint(3, count - 1))))
        while len(points) < count:
            (x, y), k = dice.choice(circle), dice.choice((-2, -1, 1, 2))
            step = gcd(x, y)
            reach = dice.choice((radius, radius, 2 * radius))
            anywhere = dice.randint(-reach, reach), dice.randint(-reach, reach)
            points.add((x - k * y // step, y + k * x // step) if dice.random() < 0.4 else anywhere)
    elif kind == "lines":
        directions = (1, 0), (0, 1), (1, 1), (2, 1), (1, 2), (1, -1), (3, 1)
        lines = [(dice.randint(0, 6), dice.randint(0, 6), *dice.choice(directions)) for _ in range(3)]
        while len(points) < count:
            (x, y, dx, dy), k = dice.choice(lines), dice.randint(-3, 3)
            points.add((x + k * dx, y + k * dy))
    else:
        while len(points) < count:
            points.add((dice.randint(0, 60), dice.randint(0, 60)))
    points = sorted(points)
    dice.shuffle(points)
    return points


def crosses(a, b, c, d):
    return (orientation(a, b, c) * orientation(a, b, d) < 0 and orientation(c, d, a) * orientation(c, d, b) < 0)


def draw_edges(dice, points, count):
    pairs = list(combinations(range(len(points)), 2))
    dice.shuffle(pairs)
    if dice.random() < 0.4:  # long ones first
        pairs.sort(key=lambda e: -dice.random() * sum((p - q) ** 2 for p, q in zip(points[e[0]], points[e[1]])))
    edges = []
    for a, b in pairs:
        p, q = points[a], points[b]
        if len(edges) == count:
            break
        if not any(crosses(p, q, points[c], points[d]) for c, d in edges) and not any(
                on_segment(x, p, q) for x in points if x not in (p, q)):
            edges.append((a, b))
    return edges


def draw_plane(dice):
    while True:
        points = draw_points(dice, dice.randint(5, 8))
        if any(orientation(*t) for t in combinations(points, 3)):
            return Scene(points, draw_edges(dice, points, dice.choice((0, 1, 2, 3, 4, 6, 9)))), None


def rings_of(points, rim):
    """Simple rings, the ground on the left, from directed edges. At a vertex a ring turns as far left as it can."""
    left, rings = set(rim), []
    while left:
        walk = [min(left)]
        while True:
            a, b = walk[-1]
            left.discard(walk[-1])

            def rank(q):
                turn = orientation(points[b], points[a], q)
                return {-1: 1, 1: 3}.get(turn, 0 if dot(points[b], points[a], q) > 0 else 2)
            order = cmp_to_key(lambda e, f: rank(points[e[1]]) - rank(points[f[1]])
                               or orientation(points[b], points[e[1]], points[f[1]]))
            following = min((edge for edge in rim if edge[0] == b), key=order)
            if following == walk[0]:
                break
            walk.append(following)
        ring = []
        for a, _ in walk:  # loops are rings of their own
            if a in ring:
                rings.append(ring[ring.index(a):])
                ring = ring[:ring.index(a)]
            ring.append(a)
        rings.append(ring)
    return rings


def draw_ground(dice):
    """Some of the triangles of a random triangulation; a few edges inside are constraint edges too."""
    while True:
        points = draw_points(dice, dice.randint(6, 9))
        if not any(orientation(*t) for t in combinations(points, 3)):
            continue
        full = Scene(points, draw_edges(dice, points, len(points) ** 2))
        share = dice.choice((0.5, 0.7, 0.85, 1))
        kept = [t for t in combinations(full.ids, 3) if all(full.is_edge(*side) for side in combinations(t, 2))
                and full.fault(t) is None and dice.random() < share]
        used = sorted({i for t in kept for i in t})
        if not used:
            continue
        half = set()
        for t in kept:
            a, b, c = (used.index(i) for i in t)
            if orientation(*full.corners(t)) < 0:
                b, c = c, b
            half |= {(a, b), (b, c), (c, a)}
        points = [points[i] for i in used]
        rim = {(a, b) for a, b in half if (b, a) not in half}
        inner = sorted((a, b) for a, b in half - rim if a < b)
        breaks = dice.sample(inner, min(len(inner), dice.choice((0, 0, 1, 2, 3))))
        rings = [[points[i] for i in ring] for ring in rings_of(points, rim)]
        return Scene(points, [*rim, *breaks], rings), breaks


def ring_text(ring):
    return "(" + ",".join(f"{x} {y}" for x, y in [*ring, ring[0]]) + ")"


def write_layer(path, shapes):
    path.write_text("id,WKT\n" + "".join(f'{i},"{shape}"\n' for i, shape in enumerate(shapes)))


def write_areas(folder, rings, apart):
    """Options that name the ground: holes in their polygons, or in a file of their own."""
    outer = {i: [ring] for i, ring in enumerate(r for r in rings if doubled_area(r) > 0)}
    holes = [ring for ring in rings if doubled_area(ring) < 0]
    for hole in holes if not apart else []:
        (ax, ay), (bx, by) = hole[:2]
        x, y = middle((ax, ay), (bx, by))
        beside = x + (by - ay) / 10**6, y - (bx - ax) / 10**6  # in the hole, close to its edge
        around = [i for i, parts in outer.items() if inside_rings(beside, parts[:1])]
        outer[min(around, key=lambda i: doubled_area(outer[i][0]))].append(hole)
    write_layer(folder / "ground.csv", [f"POLYGON ({','.join(map(ring_text, parts))})" for parts in outer.values()])
    options = ["--boundary", folder / "ground.csv"]
    if apart and holes:
        write_layer(folder / "holes.csv", [f"POLYGON ({ring_text(hole)})" for hole in holes])
        options += ["--holes", folder / "holes.csv"]
    return options


class Case:
    def __init__(self, binary, folder, number):
        self.dice, self.folder = random.Random(f"orders {number}"), folder
        self.scene, breaks = (draw_ground if number % 3 == 2 else draw_plane)(self.dice)
        points = self.scene.points
        (folder / "points.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in points))
        self.command = [binary, "order", folder / "points.csv", "-q", "--overwrite", "--threads", "1"]
        lines = self.scene.edges if breaks is None else breaks
        if lines:
            write_layer(folder / "lines.csv", [
                "LINESTRING (" + ",".join(f"{points[i][0]} {points[i][1]}" for i in line) + ")" for line in lines])
            self.command += ["--breaklines", folder / "lines.csv"]
        if self.scene.rings is not None:
            self.command += write_areas(folder, self.scene.rings, self.dice.random() < 0.5)
        self.orders = self.scene.orders()

    def run(self, *options):
        return subprocess.run([*map(str, self.command), *map(str, options)], check=True, capture_output=True,
                              text=True).stdout

    def expect(self, what, found, expected):
        if found != expected:
            raise SystemExit(f"{what}: {found}, not {expected}, of points {self.scene.points}, edges "
                             f"{self.scene.edges}, rings {self.scene.rings}")

    def compare_triangles(self):
        asked = [self.dice.sample(t, 3) for t in self.orders]
        options = [option for t in asked for option in ("--triangle", ",".join(map(str, t)))]
        answers = json.loads(self.run(*options, "-f", "json"))
        for t, answer in zip(asked, answers if len(asked) > 1 else [answers]):
            expected = self.orders[tuple(sorted(t))]
            self.expect(f"triangle {t}", answer["orders"] if answer["valid"] else answer["reason"], expected)

    def rows(self, name):
        with open(self.folder / name, encoding="ascii") as file:
            return list(csv.reader(file))[1:]

    def compare_lists(self):
        valid = {t: orders for t, orders in self.orders.items() if isinstance(orders, dict)}
        name, k = self.dice.choice(DEFINITIONS), self.dice.randint(0, 4)
        self.run("--definition", name, "--order", k, "--list-triangles", self.folder / "triangles.csv", "--list-edges",
                 self.folder / "edges.csv")
        self.expect(f"triangles, {name}, {k}", self.rows("triangles.csv"),
                    [[*map(str, t), str(orders[name])] for t, orders in valid.items() if orders[name] <= k])
        everything = self.scene.triangulations(list(valid))
        least = {}
        for triangles in everything:
            order = max(valid[t][name] for t in triangles)
            for edge in (edge for t in triangles for edge in combinations(t, 2)):
                least[edge] = min(least.get(edge, order), order)
        self.expect(f"edges, {name}, {k}", self.rows("edges.csv"),
                    [[*map(str, edge), str(order)] for edge, order in sorted(least.items()) if order <= k])
        self.compare_first_order(valid, everything)

    def compare_first_order(self, valid, everything):
        name = self.dice.choice(DEFINITIONS)
        self.run("--definition", name, "--list-conflicts", self.folder / "conflicts.csv", "--list-quadrilaterals",
                 self.folder / "quadrilaterals.csv")
        edges_of = [{edge for t in triangles for edge in combinations(t, 2)} for triangles in everything
                    if all(valid[t][name] <= 1 for t in triangles)]
        useful = sorted(set().union(*edges_of))
        apart = [[*map(str, one + other)] for one, other in combinations(useful, 2)
                 if not any(one in edges and other in edges for edges in edges_of)]
        self.expect(f"conflicts, {name}", [row[:4] for row in self.rows("conflicts.csv")], apart)
        if name in ("sees-3vtx", "empty-quad"):
            return
        delaunay = {edge for triangles in everything if all(valid[t]["pathcon"] == 0 for t in triangles)
                    for t in triangles for edge in combinations(t, 2)}
        found = set()
        for *corners, diagonal in self.rows("quadrilaterals.csv"):
            s, u, t, v = map(int, corners)
            st, uv = tuple(sorted((s, t))), tuple(sorted((u, v)))
            found.add((st, uv) if diagonal == "st" else (uv, st))
        self.expect(f"quadrilaterals, {name}", found, {
            (one, other) for one in useful for other in useful if one in delaunay and crosses(
                *(self.scene.points[i] for i in one + other))})


def main():
    binary = sys.argv[1]
    scenes, first = (int(argument) for argument in (sys.argv[2:] + ["60", "0"][len(sys.argv) - 2:]))
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, first + scenes):
            try:
                case = Case(binary, Path(folder), number)
                case.compare_triangles()
                case.compare_lists()
            except BaseException:
                print(f"scene {number}", file=sys.stderr)
                raise
    print(f"{scenes} scenes agree")


if __name__ == "__main__":
    main()
