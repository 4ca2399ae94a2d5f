#!/usr/bin/env python3
"""Pits against the order, and what the heuristics leave too many, from the rows of higher_order.md.

Usage: higher_order_plot.py TABLE.md PLOT.svg. A column a terrain, a colour a sample. Upper panels: the optimum as a share
of the pits of the Delaunay triangulation (where it is not proved, what was found). Lower panels: pits of the flip
heuristic (dashed) and of the hull heuristic (dotted) beyond the bound, in percent of it.
"""
import pathlib
import sys

COLOURS = {"points_random": "#0072b2", "points_offgrid": "#d55e00", "points_significant": "#009e73"}
WIDTH, HEIGHT, GAP, LEFT, TOP = 170, 120, 34, 64, 44


def read(path):
    """{(terrain, lines): {sample: [(k, optimum, bound, flip, hull)]}}"""
    panels = {}
    for line in pathlib.Path(path).read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) < 20 or not cells[2].isdigit():
            continue
        terrain, sample = cells[0].split(", ")
        optimum = int(cells[3])
        bound = optimum if cells[4] == "optimal" else int(float(cells[4].removeprefix("bound ")))
        rows = panels.setdefault((terrain, cells[1]), {}).setdefault(sample, [])
        rows.append((int(cells[2]), optimum, bound, int(cells[5]), int(cells[6])))
    return panels


def panel(parts, x0, y0, title, series, least, most, ticks, last):
    """series: (colour, dashes, [(k, value)])"""
    x = lambda k: x0 + k * WIDTH / last
    y = lambda value: y0 + HEIGHT * (most - value) / (most - least)
    for tick in ticks:
        parts.append(f'<line x1="{x0}" x2="{x0 + WIDTH}" y1="{y(tick):.1f}" y2="{y(tick):.1f}" stroke="#ddd"/>'
                     f'<text x="{x0 - 4}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick:g} %</text>')
    for k in range(last + 1):
        parts.append(f'<text x="{x(k):.1f}" y="{y0 + HEIGHT + 13}" text-anchor="middle">{k}</text>')
    parts.append(f'<text x="{x0}" y="{y0 - 6}">{title}</text>')
    for colour, dashes, points in series:
        way = " ".join(f"{x(k):.1f},{y(value):.1f}" for k, value in points)
        parts.append(f'<polyline points="{way}" fill="none" stroke="{colour}" stroke-width="1.6"{dashes}/>')


def main():
    panels = read(sys.argv[1])
    terrains = list(dict.fromkeys(terrain for terrain, _ in panels))
    all_rows = [row for samples in panels.values() for rows in samples.values() for row in rows]
    last = max(row[0] for row in all_rows)
    most = max(5, 5 * -(-max(100 * (max(row[3:]) / row[2] - 1) for row in all_rows if row[2]) // 5))
    width, height = LEFT + len(terrains) * (WIDTH + GAP), TOP + 4 * (HEIGHT + GAP)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
             'font-size="11"><rect width="100%" height="100%" fill="white"/>']
    for i, (sample, colour) in enumerate(COLOURS.items()):
        parts.append(f'<text x="{LEFT + 130 * i}" y="16" fill="{colour}">{sample}</text>')
    parts.append(f'<text x="{LEFT + 400}" y="16">upper: optimum; lower: more than the bound, flip dashed, hull dotted</text>')
    for (terrain, lines), samples in panels.items():
        x0 = LEFT + terrains.index(terrain) * (WIDTH + GAP)
        y0 = TOP + (2 if lines == "lines" else 0) * (HEIGHT + GAP)
        title = terrain.split("_")[0] + (", lines" if lines == "lines" else "")
        shares, gaps = [], []
        for sample, rows in samples.items():
            rows.sort()
            shares.append((COLOURS[sample], "", [(row[0], 100 * row[1] / rows[0][1]) for row in rows]))
            for column, dashes in ((3, "5 3"), (4, "1 3")):
                points = [(row[0], 100 * (row[column] / row[2] - 1)) for row in rows if row[2]]
                gaps.append((COLOURS[sample], f' stroke-dasharray="{dashes}"', points))
        panel(parts, x0, y0, title, shares, 0, 100, (0, 50, 100), last)
        panel(parts, x0, y0 + HEIGHT + GAP, title, gaps, 0, most, (0, most / 2, most), last)
    pathlib.Path(sys.argv[2]).write_text("\n".join([*parts, "</svg>"]) + "\n")


main()
