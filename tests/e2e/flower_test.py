#!/usr/bin/python3
"""terrane flower, with a server and without: flower_test.py TERRANE TERRANE_SERVER."""

import filecmp
import json
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

TERRANE, SERVER = sys.argv[1:3]
METHODS = ["perlin", "bezier", "ifs"]
# Long enough to be interrupted.
LARGE = ["--preset", "flower/sunflower", "--plants", "20000", "--progress", "json"]


def read_glb_json(path):
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    return json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])


class FlowerTest(unittest.TestCase):
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
        return self.run_terrane("flower", *arguments, "--local", **options)

    def test_server_and_local_write_the_same_bytes(self):
        choices = [
            ["--preset", "flower/rose", "--stage", "0.4", "--seed", "7"],
            ["--preset", "flower/pansy", "--method", "bezier", "--plants", "4"],
        ]
        for choice in choices:
            for extension in ["glb", "obj"]:
                remote, here = self.folder / f"r.{extension}", self.folder / f"l.{extension}"
                self.run_terrane("flower", *choice, "--out", remote, "--server", self.address)
                self.local(*choice, "--out", here)
                if extension == "obj":  # names its material file
                    self.assertEqual(remote.read_text().replace("r.mtl", "l.mtl"), here.read_text())
                    self.assertTrue((self.folder / "l.mtl").exists())
                else:
                    self.assertTrue(filecmp.cmp(remote, here, shallow=False), choice)

    def test_every_preset_makes_a_file(self):
        presets = json.loads(self.run_terrane("info", "--json", "--local").stdout)
        names = [name for name in json.dumps(presets).split('"') if name.startswith("flower/")]
        self.assertGreater(len(names), 9)
        for name in names:
            out = self.folder / "f.glb"
            summary = json.loads(self.local("--preset", name, "--json", "--out", out).stdout)
            self.assertEqual(summary["files"], [str(out)])
            self.assertNotIn("warnings", {key for key, value in summary.items() if value})
            document = read_glb_json(out)
            self.assertEqual(document["asset"]["extras"]["recipe_hash"], summary["recipe_hash"])

    def test_a_flower_is_meshes_and_instances(self):
        out = self.folder / "f.glb"
        choice = ["--preset", "flower/rose", "--json", "--out", out]
        summary = json.loads(self.local(*choice).stdout)
        document = read_glb_json(out)
        self.assertEqual(document["extensionsRequired"], ["EXT_mesh_gpu_instancing"])
        self.assertLess(out.stat().st_size, 300_000)
        self.local(*choice, "--instancing", "nodes")
        nodes = read_glb_json(out)
        self.assertEqual(len(nodes["meshes"]), len(document["meshes"]))
        self.assertEqual(len(nodes["nodes"]), 1 + len(nodes["meshes"]) + summary["instances"])

    def test_the_options_take_the_place_of_the_recipe(self):
        out = self.folder / "f.glb"
        choice = ["--preset", "flower/rose", "--out", out]
        self.local(*choice, "--seed", 5, "--stage", 0.25, "--method", "ifs", "--plants", 3)
        recipe = read_glb_json(out)["asset"]["extras"]["recipe"]
        self.assertEqual((recipe["seed"], recipe["stage"]), ("5", 0.25))
        self.assertEqual(recipe["method"], "PETAL_METHOD_IFS")
        self.assertEqual(recipe["bed"]["plants"], 3)
        hashes = set()
        for method in METHODS:
            done = self.local(*choice, "--method", method, "--json")
            hashes.add(json.loads(done.stdout)["recipe_hash"])
        self.assertEqual(len(hashes), 3)

    def test_recipes_of_files(self):
        recipe = self.folder / "mine.json"
        recipe.write_text(self.run_terrane("presets", "flower/daisy", "--json", "--local").stdout)
        for name, choice in {"a": ["--preset", "flower/daisy"], "b": ["--recipe", recipe]}.items():
            self.local(*choice, "--out", self.folder / f"{name}.glb")
        self.assertTrue(filecmp.cmp(self.folder / "a.glb", self.folder / "b.glb", shallow=False))

    def test_dry_run_estimates(self):
        control_values = {}
        for method in METHODS:
            done = self.local("--preset", "flower/rose", "--method", method, "--dry-run", "--json")
            estimate = json.loads(done.stdout)
            control_values[method] = int(estimate["control_values"])
            self.assertEqual((estimate["prototypes"], estimate["instances"]), ("12", "77"))
        self.assertEqual(control_values, {"perlin": 30, "bezier": 192, "ifs": 156})
        self.assertEqual(list(self.folder.iterdir()), [])
        text = self.local("--preset", "flower/rose", "--plants", 1000, "--dry-run").stdout
        self.assertIn("77000 instances", text)

    def test_what_is_wrong_is_named(self):
        out = ["--out", self.folder / "f.glb"]
        rose = ["--preset", "flower/rose"]
        cases = {
            "no preset is called": ["--preset", "flower/none", *out],
            "stage: must be in [0, 1], got 1.5": [*rose, "--stage", 1.5, *out],
            "plants: must be in [1, 1000000], got 0": [*rose, "--plants", 0, *out],
            "instances, got 1081000000": ["--preset", "flower/sunflower", "--plants", 1_000_000, *out],
        }
        for what, arguments in cases.items():
            self.assertIn(what, self.local(*arguments, expected=1).stderr)
        usage = {
            "--out: must end in .glb, .obj, .png or .exr": [*rose, "--out", self.folder / "f.stl"],
            "--method": [*rose, "--method", "origami", *out],
            "--out is required": rose,
        }
        for what, arguments in usage.items():
            self.assertIn(what, self.local(*arguments, expected=2).stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_relief_that_folds_is_made_with_a_warning(self):
        recipe = json.loads(self.run_terrane("presets", "flower/petal-flat", "--json", "--local").stdout)
        field = recipe.get("recipe", recipe)
        field["petals"][0]["blade"]["relief"] = {"amplitude": 1, "frequency_x": 8, "frequency_y": 8}
        path = self.folder / "folds.json"
        path.write_text(json.dumps(field))
        done = self.local("--recipe", path, "--out", self.folder / "f.glb")
        self.assertRegex(done.stderr, r"warning: petals\[0\]\.blade\.relief folds: .* is 0\.\d+, above 0\.4")

    def test_ctrl_c_leaves_no_file(self):
        for place in [["--local"], ["--server", self.address]]:
            out = self.folder / "bed.glb"
            process = subprocess.Popen(
                [TERRANE, "flower", *LARGE, "--out", str(out), *place],
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            process.stderr.readline()  # the first word of progress
            time.sleep(0.2)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(30), 130)
            process.stderr.close()
            self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
