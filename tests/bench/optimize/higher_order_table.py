#!/usr/bin/env python3
"""The rows of higher_order.md: terrains x samples x with and without lines x orders, one process each.

Usage: higher_order_table.py BENCH TERRAINS ROWS [--seconds 120] [--orders 0,1,2,3,4,auto,5,6]. Rows are added to the file
ROWS as they come, order by order; those that it has are not made again. A row that takes more than so many seconds of
processor time ends where it was, and says so. At the end the tables are printed, sorted.
"""
import argparse
import pathlib
import resource
import subprocess

TERRAINS = ["bigtujunga_srtm30", "jacksboro_lonlat", "slovenia_lidar1m", "tidal_marsh_nodata", "vermont_srtm90"]
SAMPLES = ["points_random", "points_offgrid", "points_significant"]
LINES = ["none", "lines"]
HEAD = """| points | lines | k | pits | | flip | hull | normal angles | | faces | partial | largest | labels | piece | list | \
pits | flip | hull | edge length | | s | largest angle | | s | worst bend | | s |
|""" + "---|" * 27
HEAD_AUTO = """| points | lines | k | pits | | sum of orders | | order 0 | 1 | 2 | 3 | normal angles | | list | choose |
|""" + "---|" * 15


def cells(row):
    return [cell.strip() for cell in row.strip().strip("|").split("|")]


def key(row):
    points, lines, order = cells(row)[:3]
    terrain, sample = points.split(", ")
    return TERRAINS.index(terrain), SAMPLES.index(sample), LINES.index(lines), order


def make_row(bench, folder, sample, lines, order, seconds):
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    done = subprocess.run([bench, folder, sample, lines, order], capture_output=True, text=True, preexec_fn=limit)
    if done.returncode == 0:
        return done.stdout.strip()
    why = f"more than {seconds} s" if done.returncode < 0 else done.stderr.strip().splitlines()[-1]
    return f"{done.stdout.strip() or f'| {folder.name}, {sample} | {lines} | {order} |'} {why} |"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bench")
    parser.add_argument("terrains", type=pathlib.Path)
    parser.add_argument("rows", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=120)
    parser.add_argument("--orders", default="0,1,2,3,4,auto,5,6")
    arguments = parser.parse_args()
    arguments.rows.touch()
    have = {key(row) for row in arguments.rows.read_text().splitlines()}
    for order in arguments.orders.split(","):
        for terrain in TERRAINS:
            for sample in SAMPLES:
                for lines in LINES:
                    wanted = TERRAINS.index(terrain), SAMPLES.index(sample), LINES.index(lines), order
                    if wanted in have:
                        continue
                    row = make_row(arguments.bench, arguments.terrains / terrain, sample, lines, order, arguments.seconds)
                    with arguments.rows.open("a") as out:
                        out.write(row + "\n")
    rows = sorted(arguments.rows.read_text().splitlines(), key=key)
    for head, automatic in (HEAD, False), (HEAD_AUTO, True):
        print("\n".join([head, *(row for row in rows if (cells(row)[2] == "auto") == automatic), ""]))


main()
