#!/usr/bin/python3
"""Compares the three methods of petals on one rose, and writes the table.

Run in the root of the tree: docs/flower-methods.py [TERRANE]

For the noise petals, the iterated function system and the Bezier patch: the
numbers that the sketches need, vertices, bytes of the stream, bytes of a GLB with
every petal in it, and the time of a plant on this machine. The table goes into
docs/flower.md, between its markers.
"""

import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

METHODS = {"perlin": "Perlin", "bezier": "Bézier", "ifs": "IFS"}
PRESET = "flower/rose"
PAGE = pathlib.Path("docs/flower.md")
BEGIN, END = "<!-- methods: begin -->\n", "<!-- methods: end -->\n"
# Plants of the field that is timed, and how often.
FIELDS = (1, 10, 100, 1000)
REPEATS = 5


def run(*arguments):
    done = subprocess.run([TERRANE, *map(str, arguments)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def flower(method, *arguments):
    return run("flower", "--preset", PRESET, "--method", method, "--local", "--json", *arguments)


def seconds(method, plants, folder):
    """Median of what the command needs from recipe to file."""
    return statistics.median(
        flower(method, "--plants", plants, "--out", folder / "field.glb")["seconds"] for _ in range(REPEATS))


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


def table(folder):
    head = ["method", "control values", "vertices", "stream", "GLB", "OBJ, expanded"]
    head += [f"{plants:,} plant{'s' if plants > 1 else ''}" for plants in FIELDS]
    rows = [head, ["---"] * len(head), *(row(method, folder) for method in METHODS)]
    return "".join("| " + " | ".join(map(str, cells)) + " |\n" for cells in rows)


def main():
    with tempfile.TemporaryDirectory() as folder:
        text = table(pathlib.Path(folder))
    print(text, end="")
    page = PAGE.read_text()
    pattern = re.escape(BEGIN) + ".*?" + re.escape(END)
    if not re.search(pattern, page, re.DOTALL):
        sys.exit(f"{PAGE} has no markers")
    PAGE.write_text(re.sub(pattern, lambda _: BEGIN + text + END, page, flags=re.DOTALL))


TERRANE = sys.argv[1] if len(sys.argv) > 1 else "build/release/bin/terrane"
if __name__ == "__main__":
    main()
