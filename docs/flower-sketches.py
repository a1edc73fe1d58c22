#!/usr/bin/python3
"""Draws the sketches of presets, figure 2 of the paper: docs/flower-sketches.py OUT.svg [TERRANE]

A Catmull-Rom piece of tension 1/2 from b to c, between a and d, is the Bezier cubic
with the inner points b + (c - a)/6 and c - (d - b)/6, which SVG draws by itself. Full
points are those of the sketch, hollow ones their mirror images; base and tip are added.
"""

import json
import subprocess
import sys

# A preset, the part of its recipe, the words below the picture.
PARTS = [
    ("flower/rose", "petals", 0, "rose petals"),
    ("flower/rose", "petals", 1, "sepal"),
    ("flower/rose", "leaves", 0, "rose leaf"),
    ("flower/pansy", "petals", 0, "pansy petals"),
    ("flower/water-lily", "petals", 0, "water lily petals"),
    ("flower/tulip", "petals", 0, "tulip petals"),
    ("flower/daisy", "petals", 0, "daisy ray"),
]
SCALE, CELL, HEIGHT = 150, 190, 240


def sketches(preset, part, index):
    recipe = json.loads(subprocess.run([TERRANE, "presets", preset, "--json", "--local"],
                                       check=True, capture_output=True, text=True).stdout)
    return recipe[part][index]["blade"]["sketches"]


def half_outline(sketch):
    """The points from base to tip, between the two that only bend the ends."""
    points = [(0, 0), *((point.get("x", 0), point["y"]) for point in sketch["points"]), (0, 1)]

    def end(kind, at, neighbour):
        return (-neighbour[0], neighbour[1]) if kind == "SKETCH_END_ROUND" else at

    first = end(sketch.get("base", "SKETCH_END_POINTED"), points[0], points[1])
    last = end(sketch.get("tip", "SKETCH_END_ROUND"), points[-1], points[-2])
    return [first, *points, last]


def place(x, y):
    return f"{SCALE * x:.2f} {-SCALE * y:.2f}"


def half_path(sketch, side):
    bent = half_outline(sketch)
    path = "M0 0"
    for a, b, c, d in zip(bent, bent[1:], bent[2:], bent[3:]):
        inner = [(b[k] + (c[k] - a[k]) / 6) for k in (0, 1)], [(c[k] - (d[k] - b[k]) / 6) for k in (0, 1)]
        path += "C" + ",".join(place(side * x, y) for x, y in (*inner, c))
    return path


def drawn(sketch, is_filled):
    sides = "".join(half_path(sketch, side) for side in (1, -1))
    yield f'<path d="{sides}" fill="{"#e8f0e0" if is_filled else "none"}" stroke="#305030" stroke-width="1.5"/>'
    points = half_outline(sketch)[1:-1]
    for x, y in points:
        for side in (1, -1) if x else (1,):
            fill = "#c03030" if side == 1 else "#ffffff"
            yield f'<circle cx="{side * SCALE * x:.2f}" cy="{-SCALE * y:.2f}" r="3" fill="{fill}" stroke="#c03030"/>'


def main(out):
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {CELL * len(PARTS)} {HEIGHT}" font-family="sans-serif" '
             'font-size="14" text-anchor="middle">', f'<rect width="{CELL * len(PARTS)}" height="{HEIGHT}" fill="#ffffff"/>']
    for number, (preset, part, index, words) in enumerate(PARTS):
        lines.append(f'<g transform="translate({CELL * (number + 0.5):g} {HEIGHT - 50})">')
        for k, sketch in enumerate(sketches(preset, part, index)):
            lines += drawn(sketch, k == 0)
        lines += [f'<text y="35">{words}</text>', "</g>"]
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join([*lines, "</svg>", ""]))


TERRANE = sys.argv[2] if len(sys.argv) > 2 else "build/release/bin/terrane"
if __name__ == "__main__":
    main(sys.argv[1])
