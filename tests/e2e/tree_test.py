#!/usr/bin/python3
"""terrane tree, with a server and without: tree_test.py TERRANE TERRANE_SERVER."""

import csv
import filecmp
import json
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from osgeo import gdal

gdal.UseExceptions()
TERRANE, SERVER = sys.argv[1:3]
START, END, JOINT = 5, 6, 7  # types of an SWC node


def f32(text):
    """The float32 that a number's text stands for."""
    return struct.unpack("<f", struct.pack("<f", float(text)))[0]


def read_csv_rows(path):
    """Rows of a cylinder table: start, end, radii and line of the parent."""
    with open(path, newline="") as file:
        return [
            (
                tuple(f32(row[f"start_{axis}"]) for axis in "xyz"),
                tuple(f32(row[f"end_{axis}"]) for axis in "xyz"),
                f32(row["radius"]),
                f32(row["radius_end"]),
                int(row["parent"]) - 1,
            )
            for row in csv.DictReader(file)
        ]


def read_swc_rows(path):
    """The same out of an SWC file."""
    rows, row_of_node = [], {-1: -1}
    for line in path.read_text().splitlines():
        if line.startswith("#"):
            continue
        fields = line.split()
        node, kind, parent = int(fields[0]), int(fields[1]), int(fields[6])
        place = tuple(f32(number) for number in fields[2:5])
        if kind == START:
            rows.append([place, None, f32(fields[5]), None, row_of_node[parent]])
        elif kind == END:
            rows[-1][1], rows[-1][3] = place, f32(fields[5])
        row_of_node[node] = len(rows) - 1
    return [tuple(row) for row in rows]


def read_glb_json(path):
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    return json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])


class TreeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen(
            [SERVER, "--listen", "127.0.0.1:0", "--log-level", "error"], stdout=subprocess.PIPE, text=True)
        cls.address = cls.server.stdout.readline().split()[-1]

    @classmethod
    def tearDownClass(cls):
        cls.server.send_signal(signal.SIGTERM)
        assert cls.server.wait(30) == 0
        cls.server.stdout.close()

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_terrane(self, *arguments, expected=0):
        done = subprocess.run([TERRANE, *map(str, arguments)], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, expected, done.stderr)
        return done

    def local(self, *arguments, **options):
        return self.run_terrane("tree", *arguments, "--local", **options)

    def test_server_and_local_write_the_same_bytes(self):
        for extension in ["svg", "png", "glb", "obj", "swc", "csv"]:
            for preset in ["tree/genetic", "tree/poplar"]:
                remote, here = self.folder / f"r.{extension}", self.folder / f"l.{extension}"
                choice = ["tree", "--preset", preset, "--seed", "9", "--depth", "5", "--size", "200"]
                self.run_terrane(*choice, "--out", remote, "--server", self.address)
                self.run_terrane(*choice, "--out", here, "--local")
                if extension == "obj":  # names its material file
                    self.assertEqual(remote.read_text().replace("r.mtl", "l.mtl"), here.read_text())
                else:
                    self.assertTrue(filecmp.cmp(remote, here, shallow=False), (extension, preset))

    def test_swc_and_csv_hold_the_same_rows(self):
        for preset in ["tree/genetic", "tree/oak", "tree/cantor", "tree/plain"]:
            tables = [self.folder / name for name in ["t.csv", "t.swc"]]
            for table in tables:
                self.local("--preset", preset, "--depth", "5", "--out", table)
            rows = read_csv_rows(tables[0])
            self.assertEqual(rows, read_swc_rows(tables[1]))
            self.assertGreater(len(rows), 30)
            self.assertTrue(all(parent < row for row, (*_, parent) in enumerate(rows)))

    def test_a_lower_depth_is_the_beginning_of_a_higher_one(self):
        for depth in [3, 4]:
            self.local("--preset", "tree/oak", "--depth", depth, "--out", self.folder / f"{depth}.csv")
        self.local("--preset", "tree/oak", "--depth", 5, "--lod", 1, "--out", self.folder / "lod.csv")
        three, four = (read_csv_rows(self.folder / f"{depth}.csv") for depth in [3, 4])
        self.assertEqual(four[: len(three)], three)
        self.assertEqual(read_csv_rows(self.folder / "lod.csv"), four)

    def test_svg_has_a_line_for_every_segment(self):
        out = self.folder / "t.svg"
        summary = json.loads(self.local("--preset", "tree/genetic", "--out", out, "--json").stdout)
        root = xml.etree.ElementTree.parse(out).getroot()
        lines = root.iter("{http://www.w3.org/2000/svg}line")
        self.assertEqual(sum(1 for _ in lines), summary["segments"])

    def test_levels_of_detail_get_smaller(self):
        triangles = []
        for level in range(3):
            done = self.local("--preset", "tree/oak", "--depth", 6, "--lod", level, "--json", "--out", self.folder / "t.glb")
            triangles.append(json.loads(done.stdout)["triangles"])
        self.assertGreater(triangles[0], 2 * triangles[1])
        self.assertGreater(triangles[1], 2 * triangles[2])
        self.local("--preset", "tree/oak", "--depth", 6, "--lod", "0,1,2", "--out", self.folder / "t.glb")
        document = read_glb_json(self.folder / "t.glb")
        levels = document["nodes"][0]["extensions"]["MSFT_lod"]["ids"]
        self.assertEqual(len(levels), 2)
        done = self.local("--preset", "tree/oak", "--depth", 2, "--lod", 3, "--out", self.folder / "t.glb", expected=1)
        self.assertIn("--lod: must be in [0, 2]", done.stderr)
        done = self.local("--preset", "tree/oak", "--lod", "0,1", "--out", self.folder / "t.obj", expected=1)
        self.assertIn("several levels go into a .glb", done.stderr)

    def test_leaves_and_where_the_file_came_from(self):
        out = self.folder / "t.glb"
        choice = ["--preset", "tree/oak", "--depth", 4, "--seed", 7, "--json", "--out", out]
        summary = json.loads(self.local(*choice).stdout)
        document = read_glb_json(out)
        self.assertEqual(document["extensionsRequired"], ["EXT_mesh_gpu_instancing"])
        self.assertEqual(document["asset"]["extras"]["recipe"]["seed"], "7")
        self.assertEqual(document["asset"]["extras"]["recipe_hash"], summary["recipe_hash"])
        self.local(*choice, "--instancing", "nodes", "--metres-per-unit", "0.5")
        document = read_glb_json(out)
        # The root, the wood, the leaves and each leaf.
        self.assertEqual(len(document["nodes"]), 3 + summary["leaves"])
        self.assertEqual(document["nodes"][0]["scale"], [0.5, 0.5, 0.5])
        self.assertEqual(json.loads(self.local(*choice, "--no-leaves").stdout)["leaves"], 0)

    def test_recipes_of_files_and_dimensions(self):
        recipe = self.folder / "mine.json"
        recipe.write_text(self.run_terrane("presets", "tree/genetic", "--json", "--local").stdout)
        for name, choice in {"a": ["--preset", "tree/genetic"], "b": ["--recipe", recipe]}.items():
            self.local(*choice, "--out", self.folder / f"{name}.csv")
        self.assertTrue(filecmp.cmp(self.folder / "a.csv", self.folder / "b.csv", shallow=False))
        self.local("--recipe", recipe, "--dim", 3, "--out", self.folder / "c.csv")
        self.assertTrue(any(start[1] != 0 for start, *_ in read_csv_rows(self.folder / "c.csv")))
        recipe.write_text("{\"depht\": 3}")
        done = self.local("--recipe", recipe, "--out", self.folder / "d.csv", expected=1)
        self.assertIn("is not a tree recipe", done.stderr)

    def test_any_field_of_the_recipe_can_be_set(self):
        choice = ["--preset", "tree/sparse", "--depth", 4, "--out", self.folder / "t.glb"]
        self.local(*choice, "--set", "genetic.left_share=0.25", "--set", "genetic.twigs_end=false", "--set", "genetic.density=WANTED_HIGH")
        genetic = read_glb_json(self.folder / "t.glb")["asset"]["extras"]["recipe"]["genetic"]
        self.assertEqual((genetic["left_share"], genetic["density"]), (0.25, "WANTED_HIGH"))
        self.assertIs(genetic["twigs_end"], False)
        for wrong in ["genetic.leftshare=1", "genetic.left_share", "left_share=1", "=", "genetic.density=3x"]:
            self.assertIn("--set: must be FIELD=VALUE", self.local(*choice, "--set", wrong, expected=1).stderr)

    def test_pictures_show_something(self):
        for preset in ["tree/plain", "tree/cantor-statistical", "tree/willow"]:
            out = self.folder / "t.png"
            self.local("--preset", preset, "--depth", 4, "--size", 300, "--out", out)
            pixels = gdal.Open(str(out)).ReadAsArray()
            self.assertEqual(pixels.shape[0], 3)
            self.assertGreater((pixels < 200).mean(), 0.005)

    def test_forests(self):
        choice = ["--preset", "tree/poplar", "--depth", 4, "--forest"]
        grid = [*choice, "--count", 5, "--first-seed", 3, "--spacing", 10]
        self.local(*grid, "--out", self.folder / "f.csv")
        self.local(*grid, "--out", self.folder / "f.swc")
        rows = read_csv_rows(self.folder / "f.csv")
        self.assertEqual(rows, read_swc_rows(self.folder / "f.swc"))
        bases = [start for start, *_, parent in rows if parent == -1]
        self.assertEqual(bases, [(x, y, 0) for x, y in [(0, 0), (10, 0), (20, 0), (0, 10), (10, 10)]])
        # The first of them is the tree of its seed.
        self.local("--preset", "tree/poplar", "--depth", 4, "--seed", 3, "--out", self.folder / "one.csv")
        one = read_csv_rows(self.folder / "one.csv")
        self.assertEqual(rows[: len(one)], one)

        places = self.folder / "trees.csv"
        places.write_text("x,y,z,seed,scale,yaw_deg\n1,2,3,4,2,90\n5,6,7,4,1,0\n-3,0,0,8,1,0\n")
        self.local(*choice, "--placements", places, "--out", self.folder / "p.csv")
        bases = [start for start, *_, parent in read_csv_rows(self.folder / "p.csv") if parent == -1]
        self.assertEqual(bases, [(1, 2, 3), (5, 6, 7), (-3, 0, 0)])
        done = self.local(*choice, "--placements", places, "--json", "--out", self.folder / "p.glb")
        self.assertEqual(json.loads(done.stdout)["trees"], 3)
        document = read_glb_json(self.folder / "p.glb")
        # Two seeds and a leaf; seed 4 stands twice.
        self.assertEqual(len(document["meshes"]), 3)

    def test_what_is_wrong_is_named(self):
        out = ["--out", self.folder / "t.csv"]
        cases = {
            "a tree needs one of --preset and --recipe": out,
            "no preset is called": ["--preset", "tree/none", *out],
            "must be in [0, 32], got 33": ["--preset", "tree/oak", "--depth", 33, *out],
            "a forest needs one of --count and --placements": ["--preset", "tree/oak", "--forest", *out],
            "a forest is written as": ["--preset", "tree/oak", "--forest", "--count", 2, "--out", self.folder / "t.svg"],
            "a Cantor set can be written as": ["--preset", "tree/cantor", "--out", self.folder / "t.glb"],
        }
        for what, arguments in cases.items():
            self.assertIn(what, self.local(*arguments, expected=1).stderr)
        bad = self.folder / "trees.csv"
        bad.write_text("x,y,seed\n1,2,0.5\n")
        done = self.local("--preset", "tree/oak", "--forest", "--placements", bad, *out, expected=1)
        self.assertIn("trees.csv line 2: seed must be a whole number", done.stderr)
        self.local("--preset", "tree/oak", "--out", self.folder / "t.gif", expected=2)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["trees.csv"])

    def test_dry_run_estimates(self):
        estimate = json.loads(self.local("--preset", "tree/plain", "--dry-run", "--json").stdout)
        self.assertEqual(estimate["segments_most"], "1023")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
