#!/usr/bin/env python3
"""Every criterion on each real terrain at full resolution, with lines: what it gives, what is proved, what it costs.

Usage: criteria_table.py [--verify] BINARY TERRAINS [TERRAIN...] > table.md

Prints a markdown table, a line a run: the value of the Delaunay TIN, the result, the bound, `optimal` or the gap
(difference of result and bound over the result), pieces and the quadrilaterals of the largest, the width of the
largest table, the seconds of `optimize` in the report. vertical-error takes the terrain's 8000 significant points in
place of the DEM, and the DEM as reference.

With --verify: what `thalweg verify` says of each result with its report and its proof: how many claims hold, which
are not checked, which are broken, and the seconds that it takes.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

CRITERIA = ["local-minima", "normal-angle-sum", "normal-angle-squares", "normal-angle-max", "max-area", "max-angle",
            "min-angle", "edge-length", "area-ratio-max", "area-ratio-sum", "convex-vertices", "mixed-vertices",
            "convex-edges", "max-degree", "flat-triangles", "vertical-error", "pit-depth", "valley-triangles",
            "draining-valleys"]


def terrains(root):
    for name in ("bigtujunga_srtm30", "jacksboro_lonlat", "slovenia_lidar1m", "tidal_marsh_nodata", "vermont_srtm90"):
        folder = root / name
        lines = ["--valleys", f"{folder}/lines.gpkg|layername=valleys", "--ridges", f"{folder}/lines.gpkg|layername=ridges"]
        hard = ["--valleys", f"{folder}/lines.gpkg|layername=valleys_3d", "--ridges", f"{folder}/lines.gpkg|layername=ridges_3d"]
        reference = ["--reference", folder / "dem.tif"]
        crs = ["--a-crs", "EPSG:4326"] if name.endswith("lonlat") else []
        yield name, [folder / "dem.tif", *lines], [folder / "points_significant.csv", *hard, *crs, *reference]
    delft = root / "delft_ahn3_bgt"
    yield "delft_ahn3_bgt", [delft / "ground_water_points.csv", "--a-crs", "EPSG:28992",
                             "--breaklines", f"{delft}/bgt.gpkg|layername=breaklines_3d"], None
    contours = root / "staffordshire_sk00_contours" / "contours.gpkg"
    yield "staffordshire_sk00_contours", [f"{contours}|layername=spot_heights",
                                          "--breaklines", f"{contours}|layername=contours_3d"], None
    yield "autzen_lidar_feet", [root / "autzen_lidar_feet" / "all_points.csv", "--a-crs", "EPSG:2994"], None
    yield "baja_ship_tracks_lonlat", [root / "baja_ship_tracks_lonlat" / "soundings.csv", "--a-crs", "EPSG:4326"], None


def number(value):
    return f"{value:.10g}"


def row(binary, terrain, sources, criterion, work):
    command = [binary, "build", *sources, f"{work}/t.ply", "--overwrite", "--report", f"{work}/r.json", "-q",
               "--optimize", criterion]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        print(f"{terrain} {criterion}: {done.stderr.strip()}", file=sys.stderr)
        return
    report = json.loads(pathlib.Path(f"{work}/r.json").read_text())
    line, structure = report["criteria"][0], report["first_order"]
    gap = abs(line["result"] - line["bound"])
    proved = "optimal" if line["optimal"] else f"gap {gap / max(abs(line['result']), 1e-300):.3%}"
    print(f"| {terrain} | {criterion} | {number(line['delaunay'])} | {number(line['result'])} | {number(line['bound'])} "
          f"| {proved} | {structure['pieces']} | {structure['largest_piece']} | {structure['width']} "
          f"| {report['timings_s']['optimize']:.2f} |", flush=True)


def verified(binary, terrain, sources, criterion, work):
    command = [binary, "build", *sources, f"{work}/t.ply", "--overwrite", "--report", f"{work}/r.json", "-q",
               "--optimize", criterion, "--proof", f"{work}/p.proof"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        print(f"{terrain} {criterion}: {done.stderr.strip()}", file=sys.stderr)
        return
    reference = sources[sources.index("--reference"):][:2] if "--reference" in sources else []
    started = time.monotonic()
    done = subprocess.run([binary, "verify", f"{work}/t.ply", "--report", f"{work}/r.json", "--proof", f"{work}/p.proof",
                           *reference, "-f", "json", "-q"], capture_output=True, text=True)
    seconds = time.monotonic() - started
    if done.returncode not in (0, 1) or not done.stdout:
        print(f"verify {terrain} {criterion}: status {done.returncode} {done.stderr.strip()}", file=sys.stderr)
        return
    claims = json.loads(done.stdout)["findings"]
    of = {verdict: [c["claim"] for c in claims if c["verdict"] == verdict] for verdict in ("holds", "not checked", "BROKEN")}
    print(f"| {terrain} | {criterion} | {len(of['holds'])} | {'; '.join(of['not checked'])} | {'; '.join(of['BROKEN'])} "
          f"| {done.returncode} | {seconds:.1f} |", flush=True)


def main():
    verifies = sys.argv[1] == "--verify"
    binary, root, *chosen = sys.argv[2 if verifies else 1:]
    root = pathlib.Path(root)
    if verifies:
        print("| terrain | criterion | claims that hold | not checked | broken | status | seconds |")
        print("|---|---|---|---|---|---|---|")
    else:
        print("| terrain | criterion | Delaunay | result | bound | proved | pieces | largest | width | seconds |")
        print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as work:
        for terrain, sources, thinned in terrains(root):
            for criterion in CRITERIA if not chosen or terrain in chosen else []:
                with_reference = criterion == "vertical-error"
                if not with_reference or thinned:
                    (verified if verifies else row)(binary, terrain, thinned if with_reference else sources, criterion, work)


main()
