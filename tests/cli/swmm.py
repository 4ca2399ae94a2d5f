#!/usr/bin/env python3
"""What `drain --swmm` writes, by a reader of its own that takes no more than SWMM's manual allows, and against the
layers of the same run.

usage: swmm.py THALWEG PROJECT
"""
import json
import math
import pathlib
import random
import sqlite3
import struct
import subprocess
import sys
import tempfile

NAME, NUMBER, COUNT = "name", "number", "count"
COLUMNS = {  # Rossman, SWMM user's manual 5.1, appendix D.2; words stand for themselves
    "RAINGAGES": [NAME, "INTENSITY", "1:00", NUMBER, "TIMESERIES", NAME],
    "TIMESERIES": [NAME, "0:00", NUMBER],
    "SUBCATCHMENTS": [NAME, NAME, NAME] + 5 * [NUMBER],
    "SUBAREAS": [NAME] + 5 * [NUMBER] + ["OUTLET"],
    "INFILTRATION": [NAME] + 5 * [NUMBER],
    "JUNCTIONS": [NAME] + 5 * [NUMBER],
    "OUTFALLS": [NAME, NUMBER, "FREE", "NO"],
    "STORAGE": [NAME] + 3 * [NUMBER] + ["FUNCTIONAL"] + 5 * [NUMBER],
    "CONDUITS": [NAME, NAME, NAME] + 6 * [NUMBER],
    "XSECTIONS": [NAME, "TRAPEZOIDAL"] + 4 * [NUMBER] + [COUNT],
    "COORDINATES": [NAME, NUMBER, NUMBER],
    "VERTICES": [NAME, NUMBER, NUMBER],
    "POLYGONS": [NAME, NUMBER, NUMBER],
}
OPTIONS = {"FLOW_UNITS": "CMS", "INFILTRATION": "HORTON", "FLOW_ROUTING": "DYNWAVE", "LINK_OFFSETS": "DEPTH"}


def check(holds, what):
    if not holds:
        sys.exit(what)


def read(path):
    """The rows of each section."""
    sections, rows = {}, None
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if not line.strip() or line.startswith(";"):
            continue
        check(len(line) < 1024, f"line {number} is too long for SWMM")
        if line.startswith("["):
            name = line.strip("[]")
            check(name not in sections, f"section {name} comes twice")
            rows = sections.setdefault(name, [])
        elif name == "TITLE":
            continue
        elif name in ("OPTIONS", "MAP"):
            rows.append(line.split())
        else:
            words = line.split()
            check(len(words) == len(COLUMNS[name]), f"line {number}: {len(words)} columns in {name}")
            row = []
            for word, column in zip(words, COLUMNS[name]):
                if column == NUMBER:
                    row.append(float(word))
                    check(math.isfinite(row[-1]), f"line {number}: {word}")
                elif column == COUNT:
                    row.append(int(word))
                else:
                    check(column in (NAME, word), f"line {number}: {word} instead of {column}")
                    row.append(word)
            rows.append(row)
    check(dict(sections["OPTIONS"]) == OPTIONS, "other options")
    return sections


def by_name(rows, what):
    table = {row[0]: row for row in rows}
    check(len(table) == len(rows), f"a name of {what} comes twice")
    return table


def doubled_area(ring):
    x, y = ring[0]
    return sum((a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y) for a, b in zip(ring, ring[1:] + ring[:1]))


def check_model(model):
    """Objects refer to each other as SWMM wants; returns nodes, conduits, subcatchments."""
    kinds = {kind: by_name(model[kind], kind) for kind in ("JUNCTIONS", "OUTFALLS", "STORAGE")}
    nodes = {name: row for table in kinds.values() for name, row in table.items()}
    check(len(nodes) == sum(map(len, kinds.values())), "two kinds of nodes share a name")
    conduits = by_name(model["CONDUITS"], "conduits")
    grounds = by_name(model["SUBCATCHMENTS"], "subcatchments")
    gages = by_name(model["RAINGAGES"], "gages")
    check(all(gage[5] in by_name(model["TIMESERIES"], "series") for gage in gages.values()), "a gage has no series")
    check(set(by_name(model["XSECTIONS"], "sections")) == set(conduits), "sections are not those of conduits")
    for name, _, depth, bottom, left, right, barrels in model["XSECTIONS"]:
        check(depth > 0 and bottom >= 0 and left > 0 and right > 0 and barrels == 1, f"section of {name}")
    check(set(by_name(model["COORDINATES"], "places")) == set(nodes), "places are not those of nodes")
    for table in ("SUBAREAS", "INFILTRATION"):
        check(set(by_name(model[table], table)) == set(grounds), f"{table} are not those of subcatchments")
    check({row[0] for row in model["VERTICES"]} <= set(conduits), "vertices of no conduit")
    check({row[0] for row in model["POLYGONS"]} == set(grounds), "polygons are not those of subcatchments")
    out = {}
    links = {name: 0 for name in nodes}
    for name, begin, end, length, roughness, offset, at_end, _, _ in conduits.values():
        check(begin in nodes and end in nodes and begin != end, f"ends of {name}")
        check(begin not in out and begin not in kinds["OUTFALLS"], f"two conduits leave {begin}")
        check(length > 0 and roughness > 0 and offset >= 0 and at_end == 0, f"figures of {name}")
        check(nodes[begin][1] + offset >= nodes[end][1], f"{name} rises")
        out[begin] = end
        links[begin] += 1
        links[end] += 1
    check(all(links[name] == 1 for name in kinds["OUTFALLS"]), "an outfall has not one link")
    check(all(name in out for name in kinds["JUNCTIONS"]), "a junction has no way out")
    for start in nodes:
        at, steps = start, 0
        while at in out:
            at, steps = out[at], steps + 1
            check(steps <= len(nodes), f"from {start} water runs in a circle")
        check(at in kinds["OUTFALLS"] or at in kinds["STORAGE"], f"from {start} water ends in {at}")
    for name, gage, outlet, hectares, _, width, slope, _ in grounds.values():
        check(gage in gages and outlet in nodes, f"{name} refers to nothing")
        check(hectares > 0 and width > 0 and slope >= 0, f"figures of {name}")
    return nodes, out, grounds


def check_against_layers(model, out, grounds, layers, metres):
    """Areas add up along the network as its layer says; polygons have the areas of their subcatchments."""
    rows = sqlite3.connect(layers)
    entering, leaving = {}, {}
    for blob, area in rows.execute("select geom, area_m2 from network"):
        points = line_points(blob)
        leaving[points[0]] = max(leaving.get(points[0], 0), area)
        entering[points[-1]] = entering.get(points[-1], 0) + area
    area = {name: 0.0 for name in {row[0] for row in model["COORDINATES"]}}
    for row in grounds.values():
        area[row[2]] += row[3] * 1e4
    waiting = {name: 0 for name in area}
    for end in out.values():
        waiting[end] += 1
    ready = [name for name, count in waiting.items() if count == 0]
    for name in ready:
        if name in out:
            area[out[name]] += area[name]
            waiting[out[name]] -= 1
            if waiting[out[name]] == 0:
                ready.append(out[name])
    checked = 0
    for name, x, y in model["COORDINATES"]:
        if name.startswith("J") and (x, y) in leaving:
            check(area[name] <= leaving[x, y] * (1 + 1e-9), f"{name} has more ground than its reach: {area[name]} m2, not {leaving[x, y]}")
            check(area[name] >= entering.get((x, y), 0) * (1 - 1e-9), f"{name} has less than reaches that come to it: {area[name]} m2, not {entering.get((x, y))}")
            checked += 1
    check(checked > 3, "hardly any node was compared")
    if metres:
        rings = {}
        for name, x, y in model["POLYGONS"]:
            rings.setdefault(name, []).append((x, y))
        whole = sum(1 for name, ring in rings.items() if abs(doubled_area(ring) / 2 / 1e4 / grounds[name][3] - 1) < 1e-6)
        check(whole == len(rings), f"{whole} of {len(rings)} polygons have the area of their subcatchment")


def line_points(blob):
    """Points of a GeoPackage line with z."""
    envelope = {0: 0, 1: 32, 2: 48, 3: 48, 4: 64}[blob[3] >> 1 & 7]
    at = 8 + envelope
    count = struct.unpack_from("<I", blob, at + 5)[0]
    return [struct.unpack_from("<2d", blob, at + 9 + 24 * i) for i in range(count)]


def main():
    thalweg, project = sys.argv[1], pathlib.Path(sys.argv[2])
    survey, jacksboro = project / "sample_terrains/survey", project / "sample_terrains/jacksboro"
    sources = {
        "survey": [survey / "points.csv", "--a-crs", "EPSG:32632", "--valleys", f"{survey}/lines.gpkg|layername=valleys"],
        "degrees": [jacksboro / "dem.tif", "--valleys", f"{jacksboro}/lines.gpkg|layername=valleys"],
    }
    runs = [  # source, options, whether pits are in the network
        ("survey", ["--condition", "fill,breach"], False),
        ("survey", ["--pass-pits", "100"], True),
        ("survey", [], True),
        ("degrees", ["--condition", "monotone-valleys,fill,breach"], False),
        ("degrees", ["--pass-pits", "5", "--min-area", "100000"], True),
        ("rough", ["--pass-pits", "1000", "--min-area", "0"], True),
    ]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        numbers = random.Random(4)  # many pits spill over the rim
        places = ("%r,%r,%r\n" % tuple(numbers.uniform(0, 1000) for _ in range(3)) for _ in range(600))
        (folder / "rough.csv").write_text("x,y,z\n" + "".join(places))
        sources["rough"] = [folder / "rough.csv", "--a-crs", "EPSG:32632"]
        for name, arguments in sources.items():
            subprocess.run([thalweg, "build", *arguments, folder / f"{name}.ply", "-q"], check=True)
        for source, options, with_pits in runs:
            model, layers = folder / "model.inp", folder / "water.gpkg"
            done = subprocess.run([thalweg, "drain", folder / f"{source}.ply", layers, *options, "--overwrite", "--swmm", model,
                                   "--report", "-", "-q"], check=True, capture_output=True, text=True)
            report = json.loads(done.stdout)
            figures = report["swmm"]
            read_model = read(model)
            nodes, out, grounds = check_model(read_model)
            counts = [len(read_model[kind]) for kind in ("JUNCTIONS", "OUTFALLS", "STORAGE")]
            check(counts == [figures["junctions"], figures["outfalls"], figures["storages"]], "counts of nodes")
            check([len(out), len(grounds)] == [figures["conduits"], figures["subcatchments"]], "other counts")
            noted = any("no outfall" in note for note in report["notes"])
            check(noted == (counts[1] == 0), "the note of a model without outfall")
            check((counts[2] > 0) == with_pits, f"{counts[2]} storage units")
            total = sum(row[3] for row in grounds.values()) * 1e4
            check(abs(total - figures["area_m2"]) < 1e-9 * total, "areas do not sum to the report's")
            check(total <= report["tin"]["area_m2"] * (1 + 1e-9), "more ground than the TIN has")
            check_against_layers(read_model, out, grounds, layers, source != "degrees")
            print(f"{source} {' '.join(options)}: {counts} nodes, {len(out)} conduits, {total / report['tin']['area_m2']:.3f} of the TIN")


if __name__ == "__main__":
    main()
