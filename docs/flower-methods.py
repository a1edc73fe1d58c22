#!/usr/bin/python3
"""Compares the three methods of petals on one rose, and writes the table.

Run in the root of the tree: docs/flower-methods.py [TERRANE]

For the noise petals, the iterated function system and the Bezier patch: the
numbers that the sketches need, vertices, bytes of the stream, bytes of a GLB with
every petal in it, and the time of fields of plants on this machine; and how many
frames a second the ray tracer draws of those fields. The tables go into
docs/flower.md, between its markers.
"""

import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

METHODS = {"perlin": "Perlin", "bezier": "Bézier", "ifs": "IFS"}
PRESET = "flower/rose"
PAGE = pathlib.Path("docs/flower.md")
BEGIN, END = "<!-- methods: begin -->\n", "<!-- methods: end -->\n"
# Plants of the field that is timed, and how often.
FIELDS = (1, 10, 100, 1000)
REPEATS = 5
# A frame is a pass over this picture. Its passes are timed against one alone, so
# that growing the field and writing the file do not count.
FRAME = ("--width", 640, "--height", 360)
PASSES = 17


def run(*arguments):
    done = subprocess.run([TERRANE, *map(str, arguments)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def flower(method, *arguments):
    return run("flower", "--preset", PRESET, "--method", method, "--local", "--json", *arguments)


def seconds(method, plants, folder):
    """Median of what the command needs from recipe to file."""
    return statistics.median(
        flower(method, "--plants", plants, "--out", folder / "field.glb")["seconds"] for _ in range(REPEATS))


def picture_seconds(method, plants, passes, folder):
    begin = time.monotonic()
    subprocess.run([TERRANE, *map(str, ("render", "--preset", PRESET, "--petal-method", method, "--plants", plants,
                                        "--local", *FRAME, "--passes", passes, "--out", folder / "field.png"))],
                   check=True, capture_output=True)
    return time.monotonic() - begin


def frames_per_second(method, plants, folder):
    spent = statistics.median(picture_seconds(method, plants, PASSES, folder) - picture_seconds(method, plants, 1, folder)
                              for _ in range(REPEATS))
    return (PASSES - 1) / spent


def row(method, folder):
    estimate = flower(method, "--dry-run")
    made = flower(method, "--out", folder / "one.glb")
    flower(method, "--out", folder / "whole.obj")
    times = [seconds(method, plants, folder) * 1e3 for plants in FIELDS]
    return [
        METHODS[method],
        estimate["control_values"],
        f"{made['vertices']:,.0f}",
        f"{made['data_bytes'] / 1e3:,.0f} KB",
        f"{(folder / 'one.glb').stat().st_size / 1e3:,.0f} KB",
        f"{(folder / 'whole.obj').stat().st_size / 1e6:.1f} MB",
        *(f"{time:,.1f} ms" for time in times),
    ]


def table(head, rows):
    rows = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(map(str, cells)) + " |\n" for cells in rows)


def plants_of_fields():
    return [f"{plants:,} plant{'s' if plants > 1 else ''}" for plants in FIELDS]


def sizes(folder):
    head = ["method", "control values", "vertices", "stream", "GLB", "OBJ, expanded", *plants_of_fields()]
    return table(head, (row(method, folder) for method in METHODS))


def frames(folder):
    head = ["frames a second", *plants_of_fields()]
    return table(head, ([METHODS[method], *(f"{frames_per_second(method, plants, folder):.1f}" for plants in FIELDS)]
                        for method in METHODS))


def main():
    with tempfile.TemporaryDirectory() as folder:
        text = sizes(pathlib.Path(folder)) + "\n" + frames(pathlib.Path(folder))
    print(text, end="")
    page = PAGE.read_text()
    pattern = re.escape(BEGIN) + ".*?" + re.escape(END)
    if not re.search(pattern, page, re.DOTALL):
        sys.exit(f"{PAGE} has no markers")
    PAGE.write_text(re.sub(pattern, lambda _: BEGIN + text + END, page, flags=re.DOTALL))


TERRANE = sys.argv[1] if len(sys.argv) > 1 else "build/release/bin/terrane"
if __name__ == "__main__":
    main()
