#!/usr/bin/env python3
"""Pits against the order, from the rows that bench_higher_order prints.

Usage: higher_order_plot.py TABLE.md PLOT.svg. Solid: the optimum; dashed: the flip heuristic; both as a share of the
pits of the Delaunay triangulation.
"""
import pathlib
import sys

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 640, 400, 56, 16, 220, 40


def read(path):
    series = {}
    for line in pathlib.Path(path).read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) > 5 and cells[1].isdigit():
            series.setdefault(cells[0], []).append((int(cells[1]), int(cells[2]), int(cells[4])))
    return series


def main():
    series = read(sys.argv[1])
    most = max(k for rows in series.values() for k, _, _ in rows)
    x = lambda k: LEFT + k * (WIDTH - LEFT - RIGHT) / most
    y = lambda share: TOP + (1 - share) * (HEIGHT - TOP - BOTTOM)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
             'font-size="12"><rect width="100%" height="100%" fill="white"/>']
    for share in (0, 0.25, 0.5, 0.75, 1):
        parts.append(f'<line x1="{LEFT}" x2="{x(most):.1f}" y1="{y(share):.1f}" y2="{y(share):.1f}" stroke="#ddd"/>'
                     f'<text x="{LEFT - 6}" y="{y(share) + 4:.1f}" text-anchor="end">{share:.0%}</text>')
    for k in range(most + 1):
        parts.append(f'<text x="{x(k):.1f}" y="{HEIGHT - 22}" text-anchor="middle">{k}</text>')
    parts.append(f'<text x="{x(most / 2):.1f}" y="{HEIGHT - 6}" text-anchor="middle">order</text>')
    for i, (name, rows) in enumerate(series.items()):
        colour = COLOURS[i % len(COLOURS)]
        for column, dashes in ((1, ""), (2, ' stroke-dasharray="4 3"')):
            points = " ".join(f"{x(row[0]):.1f},{y(row[column] / rows[0][1]):.1f}" for row in rows)
            parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.6"{dashes}/>')
        parts.append(f'<text x="{x(most) + 10:.1f}" y="{TOP + 14 + 18 * i}" fill="{colour}">{name}</text>')
    pathlib.Path(sys.argv[2]).write_text("\n".join([*parts, "</svg>"]) + "\n")


main()
