#!/usr/bin/env python3
"""`thalweg verify` accepts what `build` made and rejects each of: one diagonal flipped, a constraint edge missing, an
inverted triangle, a value off in the sixth digit, a forged optimum, a changed height, the report of another terrain.

Usage: verify.py BINARY SOURCE [TERRAINS]: with TERRAINS on two of its whole DEMs, else on the samples.
"""
import copy
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

BINARY, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()


class Ply:
    """The binary PLY that the program writes: doubles x y z; list and order; vertex1 vertex2 kind."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        end = data.index(b"end_header\n") + len(b"end_header\n")
        self.header = data[:end].decode()
        count = {line.split()[1]: int(line.split()[2]) for line in self.header.splitlines() if line.startswith("element")}
        self.order = "property int order" in self.header
        at = end
        self.vertices = [list(struct.unpack_from("<3d", data, at + 24 * i)) for i in range(count["vertex"])]
        at += 24 * count["vertex"]
        size = 13 + 4 * self.order
        self.faces = [list(struct.unpack_from("<3i", data, at + size * i + 1)) for i in range(count["face"])]
        at += size * count["face"]
        self.edges = [struct.unpack_from("<iiB", data, at + 9 * i) for i in range(count.get("edge", 0))]
        assert at + 9 * len(self.edges) == len(data)

    def write(self, path):
        lines = []
        for line in self.header.splitlines():
            lines.append(f"element edge {len(self.edges)}" if line.startswith("element edge") else line)
        body = [struct.pack("<3d", *v) for v in self.vertices]
        body += [struct.pack("<B3i", 3, *f) + (struct.pack("<i", 0) if self.order else b"") for f in self.faces]
        body += [struct.pack("<iiB", *e) for e in self.edges]
        pathlib.Path(path).write_bytes(("\n".join(lines) + "\n").encode() + b"".join(body))

    def turn(self, a, b, c):
        (ax, ay, _), (bx, by, _), (cx, cy, _) = (self.vertices[i] for i in (a, b, c))
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def flip_one(self):
        """Flips the first free diagonal, from the middle on, of a strictly convex quadrilateral."""
        fixed = {frozenset(e[:2]) for e in self.edges}
        sides = {(f[i], f[(i + 1) % 3]): (n, f[(i + 2) % 3]) for n, f in enumerate(self.faces) for i in range(3)}
        for (a, b), (n, c) in list(sides.items())[len(sides) // 2:]:
            if (b, a) not in sides or frozenset((a, b)) in fixed:
                continue
            m, d = sides[b, a]
            if self.turn(c, a, d) > 0 and self.turn(d, b, c) > 0:
                self.faces[n], self.faces[m] = [c, a, d], [d, b, c]
                return
        raise AssertionError("no diagonal can be flipped")


def build(name, sources, *options):
    subprocess.run([BINARY, "build", *sources, f"{name}.ply", "--report", f"{name}.json", "--proof", f"{name}.proof", "-q",
                    "--overwrite", *options], check=True)
    return Ply(f"{name}.ply"), json.loads(pathlib.Path(f"{name}.json").read_text())


def verify(tin, report, proof=None):
    pathlib.Path("report.json").write_text(json.dumps(report))
    if not isinstance(tin, str):
        tin.write("tin.ply")
        tin = "tin.ply"
    options = []
    if proof is not None:
        pathlib.Path("changed.proof").write_text(proof)
        options = ["--proof", "changed.proof"]
    done = subprocess.run([BINARY, "verify", tin, "--report", "report.json", "-f", "json", *options], capture_output=True)
    lines = json.loads(done.stdout)["findings"]
    broken = [line["claim"] + ": " + line["detail"] for line in lines if line["verdict"] == "broken"]
    unchecked = [line["claim"] for line in lines if line["verdict"] == "not checked"]
    assert (done.returncode != 0) == bool(broken), (done.returncode, broken)
    return broken, unchecked, lines


def try_terrain(name, sources, other_report):
    tin, report = build(name, sources)
    broken, unchecked, _ = verify(f"{name}.ply", report)
    assert not broken and not unchecked, (name, broken, unchecked)
    print(f"accepted {name}: {len(tin.vertices)} vertices")

    def reject(what, changed_tin, changed_report, expected, changed_proof=None):
        found, _, _ = verify(changed_tin, changed_report, changed_proof)
        assert any(expected in line for line in found), f"{name}: {what} was not rejected as '{expected}': {found}"
        print(f"rejected {name}: {what}: {found[0][:100]}")

    changed = copy.deepcopy(tin)
    changed.flip_one()
    reject("one diagonal flipped", changed, report, "")
    changed = copy.deepcopy(tin)
    del changed.edges[len(changed.edges) // 2]
    reject("a constraint edge missing", changed, report, "digest")
    changed = copy.deepcopy(tin)
    face = changed.faces[len(changed.faces) // 2]
    face[0], face[1] = face[1], face[0]
    reject("an inverted triangle", changed, report, "triangulation")
    changed = copy.deepcopy(tin)
    changed.vertices[len(changed.vertices) // 2][2] += 0.001
    reject("a changed height", changed, report, "digest")
    for key in ("delaunay", "result"):
        claims = copy.deepcopy(report)
        claims["criteria"][1][key] *= 1 + 5e-6
        reject(f"{key} off in the sixth digit", f"{name}.ply", claims, f"normal-angle-sum, {'result' if key == 'result' else 'Delaunay'}")
    reject("the report of another terrain", f"{name}.ply", other_report, "digest")

    # A true report of a TIN that is not the smoothest, said to be it.
    _, claims = build("rough", sources, "--optimize", "local-minima")
    claims["criteria"].append(dict(report["criteria"][1], optimal=False))
    _, _, lines = verify("rough.ply", claims)
    detail = next(line["detail"] for line in lines if line["claim"] == "normal-angle-sum, result")
    claims["criteria"][1]["result"] = float(detail.split("found ")[1])
    assert verify("rough.ply", claims)[0] == []
    claims["criteria"][1].update(bound=claims["criteria"][1]["result"], optimal=True)
    reject("a forged optimum", "rough.ply", claims, "normal-angle-sum, optimal")
    proof = pathlib.Path(f"{name}.proof").read_text()
    reject("a forged optimum, by the true proof", "rough.ply", claims, "the proof shows only", proof)
    try_proof(name, proof, report, reject)


def try_proof(name, proof, report, reject):
    broken, unchecked, lines = verify(f"{name}.ply", report, proof)
    assert not broken and not unchecked, (name, broken, unchecked)
    assert next(line["detail"] for line in lines if line["claim"] == "normal-angle-sum, optimal") == "by the proof"
    print(f"accepted {name}: its proof of {len(proof)} bytes")
    tin = f"{name}.ply"
    reject("a proof of another terrain", tin, report, "another terrain", pathlib.Path("other.proof").read_text())
    reject("a proof cut off", tin, report, "cut off", proof[:proof.rindex("end")])
    lines = proof.splitlines(keepends=True)
    first = next(i for i, line in enumerate(lines) if line.startswith("eliminate"))
    reject("a proof without its last steps", tin, report, "the proof shows only", "".join(lines[:first] + ["end\n"]))
    fixed = next(i for i, line in enumerate(lines) if line.startswith("fix"))
    signs = lines[fixed].replace("+", "*").replace("-", "+").replace("*", "-")
    reject("a proof with the other labels fixed", tin, report, "normal-angle-sum, optimal", "".join(lines[:fixed] + [signs] + lines[fixed + 1:]))
    cut = next(i for i, line in enumerate(lines) if line.startswith("cut"))
    wrong = lines[cut].replace("+", "*").replace("-", "+").replace("*", "-")
    reject("a proof with a cut that is none", tin, report, "cut nothing", "".join(lines[:cut] + [wrong] + lines[cut + 1:]))
    reject("a proof of other criteria", tin, report, "it is for criteria", proof.replace("local-minima,normal", "local-minima,other-normal"))


def lines_of(folder):
    return [part for kind in ("valleys", "ridges") for part in (f"--{kind}", f"{folder}/lines.gpkg|layername={kind}")]


def main():
    samples = SOURCE / "sample_terrains"
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        _, other = build("other", [samples / "tiny" / "points.csv"])
        if len(sys.argv) < 4:
            try_terrain("survey", [samples / "survey" / "points.csv", "--a-crs", "EPSG:32632", *lines_of(samples / "survey")], other)
            return
        terrains = pathlib.Path(sys.argv[3])
        if not terrains.is_dir():
            print(f"skipped: no terrains at {terrains}")
            sys.exit(77)
        for name in ("vermont_srtm90", "tidal_marsh_nodata"):
            try_terrain(name, [terrains / name / "dem.tif", *lines_of(terrains / name)], other)


main()
