#!/usr/bin/env python3
"""Water on real terrain: pits, drawn valleys, networks and conditioning, beside GRASS GIS and a priority-flood.

usage: hydrology.py THALWEG TERRAINS FOLDER [NAME...]

For each terrain: pits by depth in the raw DEM (8 neighbours), in the Delaunay TIN and in the best TINs of orders 1
to 3 (fewest pits, or least depth of pits, then smoothest); what filling adds; the share of drawn valleys that drain
along themselves; how far the network of the TIN and that of r.watershed on the rasterised TIN lie apart; what
conditioning changes, beside r.fill.dir and a plain priority-flood. Writes tables in Markdown to FOLDER, each row as
soon as it is known (pits.md, networks.md, conditioning.md), and draws both networks there. Needs grass-core,
python3-gdal, python3-scipy, python3-matplotlib.
"""
import heapq
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal, ogr
from scipy import ndimage

gdal.UseExceptions()
DEMS = ["bigtujunga_srtm30", "jacksboro_lonlat", "slovenia_lidar1m", "tidal_marsh_nodata", "vermont_srtm90"]
CLASSES = [0.01, 0.1, 0.5, 1, 5]
SHARE = 0.002  # of the cells: least ground of a stream
SURFACES = {"Delaunay": ["--optimize", "none", "--order", "0"],
            "order 1": [],
            "order 1, depth": ["--optimize", "pit-depth,normal-angle-sum"],
            "order 1, depth, drawn valleys": ["--optimize", "pit-depth,draining-valleys,normal-angle-sum"],
            "order 2": ["--order", "2"],
            "order 3": ["--order", "3"]}
SCATTERED = ["Delaunay", "order 1", "order 1, depth", "order 2", "order 3"]
STEPS = ["fill", "breach", "fill,breach"]
AROUND = [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)]


def run(*command, **options):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True, **options).stdout


def read_grid(path):
    data = gdal.Open(str(path))
    heights = data.ReadAsArray().astype(float)
    nodata = data.GetRasterBand(1).GetNoDataValue()
    valid = np.isfinite(heights) if nodata is None else np.isfinite(heights) & (heights != nodata)
    return heights, valid, data.GetGeoTransform()


def outlets_of(valid):
    """Cells from which water leaves: at the frame, or beside a cell without data."""
    inside = ndimage.binary_erosion(valid, np.ones((3, 3)), border_value=0)
    return valid & ~inside


def pits_of(heights, valid):
    """Depth of each pit of a grid: from its bottom to where its water first finds lower ground, or leaves."""
    rows, columns = heights.shape
    index = np.arange(heights.size).reshape(heights.shape)
    pairs = []
    for down, right in [(0, 1), (1, 0), (1, 1), (1, -1)]:
        a = (slice(0, rows - down), slice(max(0, -right), columns - max(0, right)))
        b = (slice(down, rows), slice(max(0, right), columns + min(0, right)))
        both = valid[a] & valid[b]
        pairs.append(np.stack([index[a][both], index[b][both]], 1))
    pairs = np.concatenate(pairs)
    z = heights.ravel()
    rise = np.maximum(z[pairs[:, 0]], z[pairs[:, 1]])
    leaving = index[outlets_of(valid)]
    root = heights.size
    pairs = np.concatenate([pairs, np.stack([leaving, np.full_like(leaving, root)], 1)])
    rise = np.concatenate([rise, z[leaving]])
    order = np.argsort(rise, kind="stable")
    parent = list(range(root + 1))
    bottom = z.tolist() + [-np.inf]

    def find(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    depths = []
    for (a, b), height in zip(pairs[order].tolist(), rise[order].tolist()):
        a, b = find(a), find(b)
        if a == b:
            continue
        if bottom[a] > bottom[b]:
            a, b = b, a
        if height > bottom[b]:
            depths.append(height - bottom[b])
        parent[b] = a
    return depths


def flooded(heights, valid):
    """Priority-flood (Barnes, Lehman, Mulla 2014): the lowest surface without pits that is nowhere lower."""
    filled = np.where(valid, np.inf, np.nan)
    queue = [(heights[r, c], r, c) for r, c in zip(*np.nonzero(outlets_of(valid)))]
    for z, r, c in queue:
        filled[r, c] = z
    heapq.heapify(queue)
    rows, columns = heights.shape
    while queue:
        z, r, c = heapq.heappop(queue)
        for dr, dc in AROUND:
            i, j = r + dr, c + dc
            if 0 <= i < rows and 0 <= j < columns and filled[i, j] == np.inf:
                filled[i, j] = max(z, heights[i, j])
                heapq.heappush(queue, (filled[i, j], i, j))
    return filled


def read_ply(path):
    """Positions, and triangles as rows of vertices, of a TIN that Thalweg wrote."""
    header, _, body = path.read_bytes().partition(b"end_header\n")
    types = {"double": "<f8", "int": "<i4", "uchar": "u1"}
    tables, offset = {}, 0
    elements = []
    for words in map(str.split, header.decode().splitlines()):
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1][2].extend([("count", types[words[2]]), (words[4], types[words[3]], 3)])
        elif words[0] == "property":
            elements[-1][2].append((words[2], types[words[1]]))
    for name, count, fields in elements:
        tables[name] = np.frombuffer(body, np.dtype(fields), count, offset)
        offset += tables[name].nbytes
    vertices = tables["vertex"]
    return np.stack([vertices["x"], vertices["y"], vertices["z"]], 1), tables["face"]["vertex_indices"]


def flooded_tin(path):
    """The same along the edges of a TIN, from its rim: what is to be added to each height."""
    positions, triangles = read_ply(path)
    heights = positions[:, 2]
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), 1)
    edges, triangles_beside = np.unique(sides, axis=0, return_counts=True)
    around = [[] for _ in heights]
    for a, b in edges.tolist():
        around[a].append(b)
        around[b].append(a)
    filled = np.full(len(heights), np.inf)
    rim = np.unique(edges[triangles_beside == 1])
    filled[rim] = heights[rim]
    queue = [(heights[v], v) for v in rim.tolist()]
    heapq.heapify(queue)
    while queue:
        z, v = heapq.heappop(queue)
        for w in around[v]:
            if filled[w] == np.inf:
                filled[w] = max(z, heights[w])
                heapq.heappush(queue, (filled[w], w))
    return np.where(np.isfinite(filled), filled - heights, 0)


class Grass:
    def __init__(self, dem, folder):
        self.place = pathlib.Path(folder) / "location"
        run("grass", "-c", dem if gdal.Open(str(dem)).GetProjection() else "XY", self.place, "-e")
        self("r.in.gdal", "-o", f"input={dem}", "output=dem")
        self("g.region", "raster=dem")

    def __call__(self, *command):
        return run("grass", self.place / "PERMANENT", "--exec", *command)

    def raster(self, name, path):
        self("r.out.gdal", f"input={name}", f"output={path}", "format=GTiff", "type=Float64", "nodata=-9999", "-f")
        return gdal.Open(str(path)).ReadAsArray()


def near_share(mine, other):
    """Share of the cells of one network that have a cell of the other within one cell."""
    return np.count_nonzero(mine & ndimage.binary_dilation(other, np.ones((3, 3)))) / max(1, np.count_nonzero(mine))


def burn(lines, dem, path):
    """Cells that the lines of a layer touch."""
    source = gdal.Open(str(dem))
    target = gdal.GetDriverByName("GTiff").Create(str(path), source.RasterXSize, source.RasterYSize, 1, gdal.GDT_Byte)
    target.SetGeoTransform(source.GetGeoTransform())
    layer_source = ogr.Open(str(lines))
    gdal.RasterizeLayer(target, [1], layer_source.GetLayerByName("network"), burn_values=[1])
    return target.ReadAsArray() == 1


def drain(thalweg, tin, output, *options):
    return json.loads(run(thalweg, "drain", tin, output, "--report", "-", "-q", "--overwrite", *options))


def by_class(depths):
    return [sum(low < d <= high for d in depths) for low, high in zip([-1, *CLASSES], [*CLASSES, np.inf])]


def pit_rows(thalweg, name, points, lines, surfaces, folder):
    for surface in surfaces:
        tin = folder / f"{name}_{surface.replace(' ', '_')}.ply"
        run(thalweg, "build", *points, tin, *lines, *SURFACES[surface], "-q", "--overwrite")
        report = drain(thalweg, tin, folder / "water.gpkg")
        classes = [c["pits"] for c in report["pits"]["interior_by_depth"]]
        held = report["consistency"]
        share = 100 * held["draining_length_m"] / held["valley_length_m"] if held["valley_length_m"] else float("nan")
        yield (surface, sum(classes), classes, report["pits"]["fill_volume_m3"], share, held["crossed_ridge_edges"],
               held["triangles_on_valleys"])


def draw(path, heights, valid, thalweg_cells, grass_cells):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    shade = np.hypot(*np.gradient(np.where(valid, heights, np.nanmean(heights[valid]))))
    light = 1 - 0.7 * np.clip(shade / np.percentile(shade[valid], 98), 0, 1)
    image = np.repeat(light[..., None], 3, 2)
    image[~valid] = 1
    both = thalweg_cells & grass_cells
    for cells, colour in ((grass_cells & ~both, (0.85, 0.2, 0.1)), (thalweg_cells & ~both, (0.1, 0.35, 0.9)),
                          (both, (0.1, 0.6, 0.2))):
        image[cells] = colour
    pyplot.imsave(path, image)


def dem_of(name, folder, heights, valid, transform, projection):
    """The DEM as doubles: what a TIN of all its cells gives back cell by cell."""
    path = folder / f"{name}_float.tif"
    rows, columns = heights.shape
    target = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 1, gdal.GDT_Float64)
    target.SetGeoTransform(transform)
    target.SetProjection(projection)
    target.GetRasterBand(1).SetNoDataValue(-9999)
    target.GetRasterBand(1).WriteArray(np.where(valid, heights, -9999))
    target.FlushCache()
    return path


class Table:
    """Rows in Markdown, each in the file at once."""

    def __init__(self, path, columns):
        self.file = open(path, "w", buffering=1)
        self.add(*columns)
        self.file.write("|---" * len(columns) + "|\n")

    def add(self, *cells):
        self.file.write("| " + " | ".join(map(str, cells)) + " |\n")


def pit_cells(name, surface, count, classes, volume, share=None, crossed=None, on_valleys=None):
    lines = ["", "", ""] if share is None or share != share else [f"{share:.1f}", crossed, on_valleys]
    return [name, surface, count, *classes, f"{volume:.4g}", *lines]


class Terrain:
    def __init__(self, folder):
        self.name = folder.name
        self.folder = folder
        self.dem = folder / "dem.tif"
        self.heights, self.valid, transform = read_grid(self.dem)
        self.transform = transform
        self.ground = abs(transform[1] * transform[5])
        if self.name.endswith("lonlat"):
            self.ground *= 111320**2 * np.cos(np.radians(transform[3]))
        self.flood = flooded(self.heights, self.valid)
        self.added = np.where(self.valid, self.flood - self.heights, 0)


def compare_pits(table, thalweg, terrain, scratch):
    name, folder = terrain.name, terrain.folder
    raw = by_class(pits_of(terrain.heights, terrain.valid))
    table.add(*pit_cells(name, "DEM, 8 neighbours", sum(raw), raw, terrain.added.sum() * terrain.ground))
    lines = ["--valleys", f"{folder}/lines.gpkg|layername=valleys", "--ridges", f"{folder}/lines.gpkg|layername=ridges"]
    for row in pit_rows(thalweg, name, [terrain.dem], lines, list(SURFACES)[:4], scratch):
        table.add(*pit_cells(name, *row))
    crs = ["--a-crs", "EPSG:4326"] if name.endswith("lonlat") else []
    for row in pit_rows(thalweg, f"{name}_off", [folder / "points_offgrid.csv"], crs, SCATTERED, scratch):
        table.add(*pit_cells(name + ", points_offgrid", *row))


def compare_networks(table, thalweg, terrain, grass, tin, floats, scratch, pictures):
    cells = int(SHARE * np.count_nonzero(terrain.valid))
    grass("r.watershed", "elevation=dem", f"threshold={cells}", "stream=streams", "accumulation=accumulation")
    streams = grass.raster("streams", scratch / f"{terrain.name}_streams.tif")
    streams = np.isfinite(streams) & (streams > 0)
    drain(thalweg, tin, scratch / "network.gpkg", "--min-area", cells * terrain.ground, "--pass-pits", 1e6)
    mine = burn(scratch / "network.gpkg", floats, scratch / "network.tif")
    table.add(terrain.name, np.count_nonzero(mine), np.count_nonzero(streams),
              f"{100 * near_share(mine, streams):.1f}", f"{100 * near_share(streams, mine):.1f}")
    draw(pictures / f"network_{terrain.name}.png", terrain.heights, terrain.valid, mine, streams)


def compare_conditioning(table, thalweg, terrain, grass, tin, scratch):
    heights, valid = terrain.heights, terrain.valid

    def add(what, count, total, most, left):
        table.add(terrain.name, what, count, f"{total:.1f}", f"{most:.2f}", left)

    def add_grid(what, change):
        add(what, np.count_nonzero(change), np.abs(change).sum(), np.abs(change).max(),
            len(pits_of(np.where(valid, heights + change, 0), valid)))

    grass("r.fill.dir", "input=dem", "output=filled", "direction=direction")
    filled = grass.raster("filled", scratch / f"{terrain.name}_filled.tif")
    add_grid("r.fill.dir, 8 neighbours", np.where(valid & (filled > -9000), filled - heights, 0))
    add_grid("priority-flood, 8 neighbours", terrain.added)
    change = flooded_tin(tin)
    add("priority-flood, along the edges of the TIN of order 1", np.count_nonzero(change), change.sum(), change.max(), 0)
    for steps in STEPS:
        report = drain(thalweg, tin, scratch / "water.gpkg", "--condition", steps)
        done = report["conditioned"]
        add(f"{steps}, on the TIN of order 1", done["heights"], done["sum_m"], done["max_m"], report["pits"]["interior"])


def main():
    thalweg, terrains, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    pits = Table(folder / "pits.md", [
        "terrain", "surface", "pits", *(f"<= {c} m" for c in CLASSES), "more", "volume to fill, m3",
        "drawn valleys that drain, %", "ridge edges crossed", "triangles on valleys"])
    networks = Table(folder / "networks.md", [
        "terrain", "cells of the TIN's network", "cells of r.watershed's",
        "of the TIN's within one cell of r.watershed's, %", "of r.watershed's within one cell of the TIN's, %"])
    conditioning = Table(folder / "conditioning.md", [
        "terrain", "what", "heights changed", "sum of changes, m", "largest, m", "pits left"])
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        for name in sys.argv[4:] or DEMS:
            terrain = Terrain(terrains / name)
            compare_pits(pits, thalweg, terrain, scratch)
            tin = scratch / f"{name}_order_1.ply"
            floats = dem_of(name, scratch, terrain.heights, terrain.valid, terrain.transform,
                            gdal.Open(str(terrain.dem)).GetProjection())
            place = scratch / f"grass_{name}"
            place.mkdir()
            grass = Grass(floats, place)
            compare_networks(networks, thalweg, terrain, grass, tin, floats, scratch, folder)
            compare_conditioning(conditioning, thalweg, terrain, grass, tin, scratch)


if __name__ == "__main__":
    main()
