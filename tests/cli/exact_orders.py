"""The eight constrained orders straight from their definitions, in integers and rationals, by brute force.

Nothing here is shared with the library or with the oracle of the C++ tests. Points are pairs of integers.
"""
from fractions import Fraction
from functools import cmp_to_key
from itertools import combinations

DEFINITIONS = ("std", "pathcon", "sees-triang", "sees-vtx", "conf-edge", "sees-opp", "sees-3vtx", "empty-quad")


def sign(x):
    return (x > 0) - (x < 0)


def orientation(a, b, c):
    return sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def dot(a, b, c):
    return (b[0] - a[0]) * (c[0] - a[0]) + (b[1] - a[1]) * (c[1] - a[1])


def on_segment(p, a, b):
    """p on the closed segment ab."""
    return orientation(a, b, p) == 0 and dot(p, a, b) <= 0


def meets(p, q, c, d):
    """Whether the open segment pq meets the closed segment cd."""
    for end in (c, d):
        if on_segment(end, p, q) and end not in (p, q):
            return True
    of_c, of_d = orientation(p, q, c), orientation(p, q, d)
    if of_c == 0 and of_d == 0:
        return on_segment(p, c, d) and on_segment(q, c, d)
    return of_c * of_d < 0 and orientation(c, d, p) * orientation(c, d, q) < 0


def side_of_circle(a, b, c, d):
    """+1 inside the circle of a, b, c, 0 on it, -1 outside."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = [
        (p[0] - d[0], p[1] - d[1], (p[0] - d[0]) ** 2 + (p[1] - d[1]) ** 2) for p in (a, b, c)]
    return orientation(a, b, c) * sign(ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx))


def in_circle(a, b, c, d):
    """The same as yes or no: of four points on a circle the last by (x, y) is lifted a little off the paraboloid."""
    side = side_of_circle(a, b, c, d)
    if side != 0:
        return side > 0
    last = max(a, b, c, d)
    if last == d:
        return False
    first, second = (p for p in (a, b, c) if p != last)
    return orientation(first, second, d) == orientation(first, second, last)


def inside_rings(p, rings):
    odd = False
    for ring in rings:
        for a, b in zip(ring, ring[1:] + ring[:1]):
            if (a[1] > p[1]) != (b[1] > p[1]) and a[0] + Fraction((p[1] - a[1]) * (b[0] - a[0])) / (b[1] - a[1]) > p[0]:
                odd = not odd
    return odd


def doubled_area(ring):
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:] + ring[:1]))


def middle(a, b):
    return Fraction(a[0] + b[0]) / 2, Fraction(a[1] + b[1]) / 2


def counter_clockwise(origin, places):
    """By direction from the origin, from that of the x axis on."""
    def half(p):
        return 0 if p[1] > origin[1] or (p[1] == origin[1] and p[0] > origin[0]) else 1
    return sorted(places, key=cmp_to_key(lambda p, q: half(p) - half(q) or -orientation(origin, p, q)))


class Scene:
    """Points, constraint edges (pairs of ids), and in polygon mode the rings of the ground."""

    def __init__(self, points, edges, rings=None):
        self.points, self.rings = points, rings
        self.edges = sorted({tuple(sorted(edge)) for edge in edges})
        self.edge_set = set(self.edges)
        self.ids = range(len(points))
        self.known_sights = {}

    def is_edge(self, a, b):
        return (min(a, b), max(a, b)) in self.edge_set

    def on_ground(self, place):
        return self.rings is None or inside_rings(place, self.rings)

    def free(self, p, q, but=None):
        """Whether the open segment between two places meets no constraint edge, save those that end in `but`."""
        return not any(meets(p, q, self.points[a], self.points[b]) for a, b in self.edges if but not in (a, b))

    def sees(self, p, q):
        key = min(p, q), max(p, q)
        if key not in self.known_sights:
            a, b = self.points[p], self.points[q]
            self.known_sights[key] = self.is_edge(p, q) or (self.free(a, b) and self.on_ground(middle(a, b)))
        return self.known_sights[key]

    def corners(self, triangle):
        return [self.points[i] for i in triangle]

    def centroid(self, triangle):
        return tuple(Fraction(sum(xy), 3) for xy in zip(*self.corners(triangle)))

    def holds(self, triangle, place):
        """The closed triangle holds the place."""
        a, b, c = self.corners(triangle)
        turn = orientation(a, b, c)
        return all(orientation(p, q, place) * turn >= 0 for p, q in ((a, b), (b, c), (c, a)))

    def fault(self, triangle):
        if orientation(*self.corners(triangle)) == 0:
            return "flat"
        if any(p not in triangle and self.holds(triangle, self.points[p]) for p in self.ids):
            return "occupied"
        sides = combinations(triangle, 2)
        if not all(self.is_edge(a, b) or self.free(self.points[a], self.points[b]) for a, b in sides):
            return "crossed"
        return None if self.on_ground(self.centroid(triangle)) else "outside"

    def meets_interior(self, triangle, p, q):
        """Whether segment pq meets the open triangle: cut to the three open half-planes something is left."""
        a, b, c = self.corners(triangle)
        if orientation(a, b, c) < 0:
            b, c = c, b
        low, high, start, end = Fraction(0), Fraction(1), self.points[p], self.points[q]
        for u, v in ((a, b), (b, c), (c, a)):
            at_start, at_end = ((v[0] - u[0]) * (x[1] - u[1]) - (v[1] - u[1]) * (x[0] - u[0]) for x in (start, end))
            if at_start <= 0 and at_end <= 0:
                return False
            if at_start <= 0:
                low = max(low, Fraction(at_start, at_start - at_end))
            elif at_end <= 0:
                high = min(high, Fraction(at_start, at_start - at_end))
        return low < high

    def beyond(self, triangle, p):
        """(u, v, w): p lies beyond side uv, w is opposite."""
        a, b, c = triangle
        at = self.points
        sides = [(u, v, w) for u, v, w in ((a, b, c), (b, c, a), (c, a, b))
                 if orientation(at[u], at[v], at[w]) * orientation(at[u], at[v], at[p]) < 0]
        assert len(sides) == 1
        return sides[0]

    def sees_side(self, p, u, v):
        """Cuts the side where lines from p through vertices meet it; looks at the middle of each part."""
        if self.is_edge(u, v):
            return False
        a, b, eye = self.points[u], self.points[v], self.points[p]
        along = b[0] - a[0], b[1] - a[1]
        cuts = {Fraction(0), Fraction(1)}
        for q in self.points:
            d = q[0] - eye[0], q[1] - eye[1]
            across = d[1] * along[0] - d[0] * along[1]
            if across != 0:
                at = Fraction((a[1] - eye[1]) * d[0] - (a[0] - eye[0]) * d[1], across)
                if 0 < at < 1:
                    cuts.add(at)
        cuts = sorted(cuts)
        for one, other in zip(cuts, cuts[1:]):
            at = (one + other) / 2
            place = a[0] + at * along[0], a[1] + at * along[1]
            if self.free(eye, place, but=p) and self.on_ground(middle(eye, place)):
                return True
        return False

    def reached(self, triangle, inside):
        """Pathcon: a taut path bends at ends of constraint edges strictly inside, in one of the sectors in which the
        edges part the ground around each; from sector to sector it runs free, or along an edge on one of its sides."""
        at, start = self.points, self.centroid(triangle)
        ends = {end for edge in self.edges for end in edge}
        bends = [i for i in ends if i not in triangle and side_of_circle(*self.corners(triangle), at[i]) > 0]
        rays = {i: counter_clockwise(at[i], [at[b if a == i else a] for a, b in self.edges if i in (a, b)])
                for i in bends}

        def sector(i, place):
            """Between which rays at i the direction to a place points: the number of the one before."""
            turned = counter_clockwise(at[i], rays[i] + [place])
            return (turned.index(place) - 1) % len(rays[i])

        def sides(i, j):
            """Of edge ij the sectors at i left and right of it."""
            number = rays[i].index(at[j])
            return number, (number - 1) % len(rays[i])

        seen, found = set(), set()
        open_nodes = [(None, None)]
        while open_nodes:
            i, own = open_nodes.pop()
            here = start if i is None else at[i]

            def leads_to(j):
                """The sides of edge ij that are open from here, or a free way."""
                if i is not None and self.is_edge(i, j):
                    return [turn for turn in (0, 1) if sides(i, j)[turn] == own]
                if not self.free(here, at[j]) or (i is not None and sector(i, at[j]) != own):
                    return []
                return ["free"]

            for j in bends:
                for way in leads_to(j) if j != i else []:
                    node = j, sector(j, here) if way == "free" else sides(j, i)[1 - way]
                    if node not in seen:
                        seen.add(node)
                        open_nodes.append(node)
            found.update(p for p in inside if p == i or leads_to(p))
        return found

    def counted(self, triangle):
        """For each definition the set of points counted. The triangle is valid."""
        inside = [p for p in self.ids
                  if p not in triangle and in_circle(*self.corners(triangle), self.points[p])]
        sets = {name: set() for name in DEFINITIONS}
        sets["std"] = set(inside)
        sets["pathcon"] = self.reached(triangle, inside)
        for p in inside:
            u, v, w = self.beyond(triangle, p)
            light = self.sees_side(p, u, v)
            opposite = not self.is_edge(u, v) and self.sees(p, w)
            three = opposite and self.sees(p, u) and self.sees(p, v)
            counts = {
                "sees-triang": light,
                "sees-vtx": light and any(self.sees(p, x) for x in (u, v, w)),
                "conf-edge": any(r != p and self.meets_interior(triangle, p, r) and self.sees(p, r)
                                 for r in {*inside, u, v, w}),
                "sees-opp": opposite,
                "sees-3vtx": three,
                "empty-quad": three and not any(q not in (u, v, p) and self.holds((u, v, p), self.points[q])
                                                for q in self.ids)}
            for name, yes in counts.items():
                if yes:
                    sets[name].add(p)
        return sets

    def orders(self):
        """For each three points their fault, or the orders by definition."""
        found = {}
        for triangle in combinations(self.ids, 3):
            fault = self.fault(triangle)
            found[triangle] = fault or {name: len(points) for name, points in self.counted(triangle).items()}
        return found

    def area(self):
        """Doubled, of the ground."""
        if self.rings is not None:
            return sum(map(doubled_area, self.rings))
        chains = []
        for places in (sorted(self.points), sorted(self.points, reverse=True)):
            chain = []
            for p in places:
                while len(chain) > 1 and orientation(chain[-2], chain[-1], p) <= 0:
                    chain.pop()
                chain.append(p)
            chains += chain[:-1]
        return doubled_area(chains)

    def triangulations(self, triangles):
        """All sets of the triangles that do not overlap and fill the ground."""
        def overlap(one, other):
            for x, y in ((one, other), (other, one)):
                a, b, c = self.corners(x)
                turn = orientation(a, b, c)
                sides = (a, b), (b, c), (c, a)
                if any(all(orientation(p, q, r) * turn <= 0 for r in self.corners(y)) for p, q in sides):
                    return False
            return True

        apart = {t: {s for s in triangles if s != t and not overlap(s, t)} for t in triangles}
        areas = {t: abs(doubled_area(self.corners(t))) for t in triangles}
        total, found = self.area(), []

        def extend(chosen, area, left):
            if area == total:
                found.append(chosen)
                return
            if not left or area + sum(areas[t] for t in left) < total:
                return
            # The triangle that excludes fewest is in, or one that it excludes.
            t = min(sorted(left), key=lambda s: len(left - apart[s]))
            extend(chosen + [t], area + areas[t], left & apart[t])
            if len(left - apart[t]) > 1:
                extend(chosen, area, left - {t})

        extend([], 0, set(triangles))
        return found
