#!/usr/bin/python3
"""The real programs together: terrane against a terrane-server on port 0.

Usage: cli_test.py TERRANE TERRANE_SERVER TEST_DATA [unittest arguments]
"""

import filecmp
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()
osr.UseExceptions()
TERRANE, SERVER, DATA = sys.argv[1:4]
DEM = os.path.join(DATA, "jacksboro-3arcsec-4326.tif")


def start_server():
    """A server on a free port: the process and its address."""
    process = subprocess.Popen([SERVER, "--listen", "127.0.0.1:0", "--log-level", "error"], stdout=subprocess.PIPE, text=True)
    line = process.stdout.readline()
    assert line.startswith("listening on "), line
    return process, line.split()[-1]


class CliTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server, cls.address = start_server()

    @classmethod
    def tearDownClass(cls):
        cls.server.send_signal(signal.SIGTERM)
        assert cls.server.wait(30) == 0
        cls.server.stdout.close()

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_terrane(self, *arguments, expected=0, **options):
        done = subprocess.run([TERRANE, *map(str, arguments)], capture_output=True, text=True, timeout=120, **options)
        self.assertEqual(done.returncode, expected, done.stderr)
        return done

    def ask(self, *arguments, **options):
        return self.run_terrane(*arguments, "--server", self.address, **options)

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_server_and_local_write_the_same_bytes(self):
        choices = [
            ["--preset", "fbm/fig06b"],
            ["--dem", DEM, "--level", "2", "--window", "100,200,500,333"],
            ["--seed", "7", "--level", "20", "--window", "-300,1000000,300,200", "--sampling", "area"],
        ]
        for number, choice in enumerate(choices):
            for extension in ["tif", "png", "exr", "r16", "f32"]:
                remote, local = self.folder / f"r{number}.{extension}", self.folder / f"l{number}.{extension}"
                self.ask("terrain", *choice, "--out", remote)
                self.run_terrane("terrain", *choice, "--local", "--threads", "3", "--out", local)
                self.assertTrue(filecmp.cmp(remote, local, shallow=False), (choice, extension))

    def test_surfaces_are_the_same_from_the_server_and_locally(self):
        for extension in ["glb", "obj", "tif", "f32"]:
            remote, local = self.folder / f"r.{extension}", self.folder / f"l.{extension}"
            choice = ["surface", "--preset", "surface/fig05", "--size", "300x270", "--seed", "9"]
            self.ask(*choice, "--out", remote)
            self.run_terrane(*choice, "--local", "--threads", "3", "--out", local)
            self.assertTrue(filecmp.cmp(remote, local, shallow=False), extension)

    def test_a_surface_of_a_net_from_a_file(self):
        net = self.folder / "net.csv"
        net.write_text("x,y,z\n" + "".join(f"{i},{j},{i * j}\n" for j in range(5) for i in range(4)))
        out = self.folder / "net.tif"
        self.ask("surface", "--net", net, "--net-columns", "4", "--basis", "bicubic-hermite", "--size", "31x41", "--out", out)
        heights = gdal.Open(str(out)).ReadAsArray()
        self.assertEqual(heights.shape, (41, 31))
        # Trained to a response of 1, the corners keep their points.
        self.assertAlmostEqual(float(heights[40, 30]), 12, places=4)
        failed = self.ask("surface", "--net", net, "--out", self.folder / "x.glb", expected=1)
        self.assertIn("20 points make no rectangle", failed.stderr)

    def test_refined_model_keeps_its_posts_and_place(self):
        out = self.folder / "fine.tif"
        summary = json.loads(self.ask("terrain", "--dem", DEM, "--level", "3", "--out", out, "--json").stdout)
        self.assertEqual(summary["files"], [str(out)])
        self.assertEqual(summary["samples"], 3217 * 2745)
        coarse, fine = gdal.Open(DEM), gdal.Open(str(out))
        numpy.testing.assert_array_equal(fine.ReadAsArray()[::8, ::8], coarse.ReadAsArray())
        self.assertTrue(fine.GetSpatialRef().IsSame(coarse.GetSpatialRef()))
        self.assertEqual(fine.GetMetadataItem("AREA_OR_POINT"), "Point")
        first = coarse.GetGeoTransform()
        post = (first[0] + first[1] / 2, first[3] + first[5] / 2)
        placed = fine.GetGeoTransform()
        self.assertAlmostEqual(placed[0] + placed[1] / 2, post[0], places=12)
        self.assertAlmostEqual(placed[3] + placed[5] / 2, post[1], places=12)
        self.assertAlmostEqual(placed[1] * 8, first[1], places=15)

    def test_tiles_are_cuts_of_the_whole_with_one_range(self):
        choice = ["--dem", DEM, "--level", "1"]
        self.ask("terrain", *choice, "--out", self.folder / "whole.f32")
        whole = numpy.fromfile(self.folder / "whole.f32", "<f4").reshape(687, 805)
        self.ask("terrain", *choice, "--tiles", "all", "--tile-size", "257", "--out", self.folder / "f" / "t.f32")
        self.ask("terrain", *choice, "--tiles", "0,0,3,2", "--tile-size", "257", "--out", self.folder / "r" / "{y}-{x}.r16")
        self.assertEqual(len(list((self.folder / "f").glob("*.f32"))), 6)
        ranges = set()
        for y in range(2):
            for x in range(3):
                cut = whole[y * 256 : y * 256 + 257, x * 256 : x * 256 + 257]
                exact = numpy.fromfile(self.folder / "f" / f"t_x{x}_y{y}.f32", "<f4").reshape(257, 257)
                numpy.testing.assert_array_equal(exact, cut)
                name = self.folder / "r" / f"{y}-{x}.r16"
                sidecar = json.loads(name.with_name(name.name + ".json").read_text())
                ranges.add((sidecar["minimum"], sidecar["maximum"]))
                step = (sidecar["maximum"] - sidecar["minimum"]) / 65535
                heights = sidecar["minimum"] + numpy.fromfile(name, "<u2").reshape(257, 257) * step
                self.assertLess(abs(heights - cut).max(), 0.52 * step)
        self.assertEqual(len(ranges), 1)

    def test_interrupt_removes_the_half_written_file(self):
        out = self.folder / "huge.tif"
        process = subprocess.Popen(
            [TERRANE, "terrain", "--server", self.address, "--level", "3", "--window", "0,0,60000,60000", "--out", str(out)],
            stderr=subprocess.PIPE,
            text=True,
        )
        deadline = time.monotonic() + 60
        while not any(path.stat().st_size > 100_000 for path in self.folder.iterdir()):
            self.assertLess(time.monotonic(), deadline)
            self.assertIsNone(process.poll())
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130, errors)
        self.assertEqual(self.names(), [])

    def test_killed_server_ends_in_order(self):
        server, address = start_server()
        process = subprocess.Popen(
            [TERRANE, "terrain", "--server", address, "--window", "0,0,60000,60000", "--out", str(self.folder / "a.f32")],
            stderr=subprocess.PIPE,
            text=True,
        )
        deadline = time.monotonic() + 60
        while not any(path.stat().st_size > 100_000 for path in self.folder.iterdir()):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        server.kill()
        server.wait()
        server.stdout.close()
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 4, errors)
        self.assertIn("does not answer", errors)
        self.assertEqual(self.names(), [])

    def test_full_disk_leaves_nothing_and_spares_what_was_there(self):
        out = self.folder / "a.tif"
        out.write_text("old")

        def small_files():
            import resource

            resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, 30_000))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

        done = self.ask("terrain", "--preset", "demo/hills", "--out", out, expected=1, preexec_fn=small_files)
        self.assertIn(str(out), done.stderr)
        self.assertEqual(self.names(), ["a.tif"])
        self.assertEqual(out.read_text(), "old")

    def test_some_tiles_written_is_partial(self):
        (self.folder / "t_x1_y0.f32").mkdir()
        self.ask("terrain", "--tiles", "0,0,3,1", "--out", self.folder / "t.f32", expected=3)
        self.assertIn("t_x0_y0.f32", self.names())
        self.assertNotIn("t_x2_y0.f32", self.names())

    def test_usage_errors(self):
        out = self.folder / "a.tif"
        for arguments in [
            [],
            ["terrian"],
            ["terrain"],
            ["terrain", "--out", self.folder / "a.jpg"],
            ["terrain", "--out", out, "--source", "perlin"],
            ["terrain", "--out", out, "--window", "0,0,5"],
            ["terrain", "--out", out, "--preset", "a", "--dem", DEM],
            ["terrain", "--out", out, "--band", "1"],
            ["terrain", "--out", out, "--level", "-1"],
            ["terrain", "--out", out, "--range", "5,5"],
            ["terrain", "--out", out, "--tile-size", "255"],
            ["terrain", "--out", out, "--tiles", "1,2"],
            ["terrain", "--out", out, "--spots", self.folder / "missing.csv"],
            ["terrain", "--out", out, "--field", "z"],
            ["verify", DEM],
            ["render", DEM, "--out", self.folder / "a.jpg"],
            ["render", self.folder / "missing.tif", "--out", self.folder / "a.png"],
        ]:
            if arguments[:1] == ["terrain"]:
                arguments = [*arguments, "--server", self.address]
            self.run_terrane(*arguments, expected=2)
        self.assertEqual(self.names(), [])

    def test_wrong_values_are_named_with_their_range(self):
        done = self.ask(
            "terrain", "--roughness", "1.7", "--fidelity", "-1", "--window", "0,0,8,8", "--out", self.folder / "a.f32", expected=1
        )
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 2, lines)
        self.assertRegex(lines[0], r"roughness: must be in \(0, 1\), got 1.7")
        self.assertRegex(lines[1], r"fidelity: must be .*, got -1")
        self.ask("terrain", "--preset", "no/such", "--out", self.folder / "a.f32", expected=1)
        self.ask("terrain", "--dem", __file__, "--out", self.folder / "a.f32", expected=1)
        self.assertEqual(self.names(), [])

    def test_nobody_there_is_exit_code_4(self):
        for command in [["info"], ["presets"], ["terrain", "--window", "0,0,8,8", "--out", self.folder / "a.f32"]]:
            done = self.run_terrane(*command, "--server", "127.0.0.1:1", expected=4)
            self.assertIn("127.0.0.1:1", done.stderr)
        self.assertEqual(self.names(), [])

    def test_server_from_the_environment_and_local_before_it(self):
        environment = {**os.environ, "TERRANE_SERVER": self.address}
        info = json.loads(self.run_terrane("info", "--json", env=environment).stdout)
        self.assertGreater(info["limits"]["max_level"], 0)
        environment["TERRANE_SERVER"] = "127.0.0.1:1"
        self.run_terrane("info", "--local", env=environment)

    def test_preset_as_a_recipe_gives_the_same_terrain(self):
        recipe = self.folder / "r.json"
        recipe.write_text(self.ask("presets", "fbm/fig06b", "--json").stdout)
        hashes = set()
        for number, choice in enumerate([["--preset", "fbm/fig06b"], ["--recipe", recipe]]):
            arguments = [*choice, "--level", "4", "--out", self.folder / f"{number}.f32", "--json"]
            hashes.add(json.loads(self.ask("terrain", *arguments).stdout)["recipe_hash"])
        self.assertEqual(len(hashes), 1)
        self.assertTrue(filecmp.cmp(self.folder / "0.f32", self.folder / "1.f32", shallow=False))

    def test_profile_is_csv_of_the_whole_domain(self):
        lines = self.ask("profile", "--preset", "fbm/fig04a", "--level", "3").stdout.splitlines()
        self.assertEqual(lines[0], "x,height,macro")
        rows = [tuple(map(float, line.split(","))) for line in lines[1:]]
        self.assertEqual((len(rows) - 1) % 8, 0)
        # Figure 4a is the macro shape itself.
        self.assertTrue(all(height == macro for _, height, macro in rows))

    def test_heights_at_posts_are_the_posts(self):
        model = gdal.Open(DEM)
        place = model.GetGeoTransform()
        posts = [(0, 0), (17, 5), (402, 343)]
        points = "".join(f"{place[0] + (i + 0.5) * place[1]!r},{place[3] + (j + 0.5) * place[5]!r}\n" for i, j in posts)
        lines = self.ask("heights", "--dem", DEM, "--level", "0", input=points).stdout.splitlines()
        self.assertEqual(lines[0], "x,y,z")
        values = model.ReadAsArray()
        for line, (i, j) in zip(lines[1:], posts):
            self.assertAlmostEqual(float(line.split(",")[2]), values[j, i], delta=1e-3)

    def test_dry_run_writes_nothing(self):
        estimate = json.loads(self.ask("terrain", "--dem", DEM, "--level", "5", "--dry-run", "--json").stdout)
        self.assertEqual(int(estimate["samples"]), (402 * 32 + 1) * (343 * 32 + 1))
        self.assertEqual(self.names(), [])

    def test_progress_as_json_on_standard_error(self):
        done = self.ask("terrain", "--preset", "demo/hills", "--out", self.folder / "a.f32", "--progress", "json")
        last = json.loads(done.stderr.splitlines()[-1])
        self.assertEqual(last["samples"], last["total"])

    def write_spots(self, name, rows, header="x,y,z"):
        path = self.folder / name
        path.write_text("\n".join([header, *(",".join(repr(float(value)) for value in row) for row in rows)]) + "\n")
        return path

    def write_layer(self, name, features, epsg):
        """A GeoPackage of WKT geometries with their elevations."""
        crs = osr.SpatialReference()
        crs.ImportFromEPSG(epsg)
        crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        path = self.folder / name
        source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
        layer = source.CreateLayer("survey", crs)
        layer.CreateField(ogr.FieldDefn("elevation", ogr.OFTReal))
        for text, elevation in features:
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(ogr.CreateGeometryFromWkt(text))
            feature.SetField("elevation", elevation)
            layer.CreateFeature(feature)
        return path

    def test_spots_of_a_csv_are_met_exactly(self):
        random = numpy.random.default_rng(7)
        place = random.choice(257 * 257, 500, replace=False)
        rows = [(index % 257, index // 257, height) for index, height in zip(place, random.normal(0, 30, 500))]
        spots = self.write_spots("spots.csv", rows)
        choice = ["--seed", "7", "--fidelity", "100", "--window", "0,0,257,257", "--spots", spots]
        out, local = self.folder / "a.tif", self.folder / "b.tif"
        done = self.ask("terrain", *choice, "--out", out)
        self.assertIn("500 spots met exactly at level 0, farthest moved 0 by snapping", done.stderr)
        self.run_terrane("terrain", *choice, "--local", "--out", local)
        self.assertTrue(filecmp.cmp(out, local, shallow=False))
        report = json.loads(self.run_terrane("verify", out, "--spots", spots, "--json").stdout)
        self.assertTrue(report["passed"])
        self.assertEqual((report["spots"], report["on_samples"]["count"]), (500, 500))
        heights = gdal.Open(str(out)).ReadAsArray()
        for x, y, z in rows:
            self.assertEqual(heights[int(y), int(x)], numpy.float32(z))

    def test_spots_of_a_layer_are_brought_into_the_models_crs(self):
        model = gdal.Open(DEM)
        place = model.GetGeoTransform()
        # Samples of level 1 between the posts, whose heights are the model's own.
        points = [(place[0] + i * place[1], place[3] + j * place[5], 900 + i) for i, j in [(40, 30), (200, 111), (333, 222)]]
        web = osr.SpatialReference()
        web.ImportFromEPSG(3857)
        degrees = model.GetSpatialRef()
        degrees.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        to_web = osr.CoordinateTransformation(degrees, web)
        features = []
        for x, y, z in points:
            web_x, web_y, _ = to_web.TransformPoint(x, y)
            features.append((f"POINT ({web_x!r} {web_y!r})", z))
        spots = self.write_layer("spots.gpkg", features, 3857)
        out = self.folder / "met.tif"
        choice = ["--dem", DEM, "--level", "1", "--spots", spots, "--field", "elevation"]
        done = self.ask("terrain", *choice, "--out", out)
        self.assertIn("3 spots met exactly at level 1", done.stderr)
        self.run_terrane("verify", out, "--spots", spots, "--field", "elevation", "--tolerance", "0.001")
        done = self.run_terrane("verify", DEM, "--spots", spots, "--field", "elevation", "--tolerance", "1", expected=1)
        self.assertIn("not met", done.stdout)

    def test_lines_are_spots_all_along(self):
        river = self.write_layer("river.gpkg", [("LINESTRING Z (8 40 60, 56 40 12)", 0)], 3857)
        out = self.folder / "a.tif"
        self.ask("terrain", "--fidelity", "25", "--window", "0,0,65,65", "--spots", river, "--out", out)
        heights = gdal.Open(str(out)).ReadAsArray()
        numpy.testing.assert_allclose(heights[40, 8:57], numpy.linspace(60, 12, 49), atol=1e-4)

    def test_spots_that_contradict_are_named_by_line(self):
        spots = self.write_spots("spots.csv", [(1, 1, 5), (9, 9, 2), (1, 1, 6)])
        out = self.folder / "a.tif"
        done = self.ask("terrain", "--window", "0,0,16,16", "--spots", spots, "--out", out, expected=1)
        self.assertIn("spots.csv line 4:", done.stderr)
        self.assertFalse(out.exists())

    def test_profile_and_heights_meet_spots(self):
        spots = self.write_spots("line.csv", [(1, 4.5), (2.5, 5)], header="x,z")
        lines = self.ask("profile", "--preset", "fbm/fig04b", "--level", "6", "--spots", spots).stdout.splitlines()[1:]
        profile = {float(x): float(height) for x, height, _ in (line.split(",") for line in lines)}
        self.assertEqual((profile[1.0], profile[2.5]), (4.5, 5))
        spots = self.write_spots("plane.csv", [(3, 4, 11.5)])
        lines = self.ask("heights", "--spots", spots, input="3,4\n").stdout.splitlines()
        self.assertEqual(lines[1], "3,4,11.5")

    def test_progress_of_a_preparation_as_json(self):
        rows = [(7 * i, 5 * j, (i * j) % 13) for i in range(60) for j in range(60)]
        spots = self.write_spots("spots.csv", rows)
        out = self.folder / "a.f32"
        done = self.ask("terrain", "--window", "0,0,9,9", "--spots", spots, "--out", out, "--progress", "json")
        lines = [json.loads(line) for line in done.stderr.splitlines() if line.startswith("{")]
        prepared = [line["prepared"] for line in lines if "prepared" in line]
        self.assertEqual(prepared, sorted(prepared))
        self.assertEqual(lines[-1]["samples"], 81)

    def test_pictures_of_every_kind(self):
        self.ask("terrain", "--preset", "demo/hills", "--out", self.folder / "a.r16")
        self.ask("profile", "--preset", "fbm/fig04c", "--out", self.folder / "a.csv")
        pictures = {
            "relief": [DEM],
            "raw": [self.folder / "a.r16", "--style", "hillshade"],
            "grey": [DEM, "--style", "grey"],
            "block": [DEM, "--style", "perspective", "--water-level", "290", "--width", "400"],
            "plot": [self.folder / "a.csv", "--marks", "1,2"],
            "both": ["--side-by-side", DEM, DEM, "--width", "300"],
            "four": ["--side-by-side", DEM, DEM, DEM, DEM, "--width", "200"],
            "spots": ["--preset", "demo/spots", "--show-spots", "--local"],
            "line-preset": ["--preset", "fbm/fig04c", "--server", self.address],
            "field-preset": ["--preset", "fbm/fig06c", "--server", self.address],
        }
        for name, arguments in pictures.items():
            out = self.folder / f"{name}.png"
            self.run_terrane("render", *arguments, "--out", out)
            pixels = gdal.Open(str(out)).ReadAsArray()
            self.assertEqual(pixels.shape[0], 3)
            self.assertGreater(pixels.std(), 10, name)

    def test_pictures_refuse_options_that_they_would_not_heed(self):
        plot = self.folder / "plot.csv"
        plot.write_text("x,height\n0,1\n1,2\n")
        for subject, options in {
            (DEM,): ["--preset=demo/hills", "--seed=1", "--level=3", "--passes=9", "--tilt=30", "--marks=1", "--size=9x9"],
            (plot,): ["--band=1", "--style=grey", "--light=1,2", "--exaggeration=2", "--turn=3"],
            ("--side-by-side", DEM, DEM): ["--water-level=1", "--style=relief", "--turn=3", "--show-spots"],
            ("--preset=demo/hills",): ["--band=1", "--size=9x9", "--control-net", "--stage=1", "--height=99"],
            ("--preset=demo/hills", "--style=traced"): ["--water-level=1", "--title=a", "--show-spots"],
            ("--preset=surface/fig07",): ["--style=relief", "--level=3", "--roughness=0.5", "--passes=9"],
            ("--preset=surface/fig07", "--style=traced"): ["--control-net", "--exaggeration=2"],
            ("--preset=tree/plain",): ["--style=relief", "--size=9x9", "--exaggeration=2", "--plants=2"],
            ("--preset=flower/rose",): ["--size=9x9", "--control-net", "--window=0,0,9,9", "--title=a"],
        }.items():
            for option in options:
                done = self.run_terrane("render", *subject, option, "--local", "--out", self.folder / "a.png", expected=2)
                self.assertIn(f"{option.split('=')[0]}: is of ", done.stderr)
        done = self.run_terrane("render", "--side-by-side", DEM, DEM, "--style=traced", "--out", self.folder / "a.png", expected=1)
        self.assertIn("--style traced: must be of a preset", done.stderr)
        self.assertEqual(self.names(), ["plot.csv"])

    def test_traced_pictures_are_the_same_from_the_server_and_locally(self):
        subjects = [
            ["--preset", "surface/fig07", "--size", "65x65", "--ground", "--shading", "blinn-phong"],
            ["--preset", "demo/hills", "--window", "0,0,60,60"],
        ]
        for subject in subjects:
            for extension in ["png", "exr"]:
                remote, local = self.folder / f"r.{extension}", self.folder / f"l.{extension}"
                choice = ["render", *subject, "--style", "traced", "--width", "90", "--height", "60", "--passes", "4"]
                self.ask(*choice, "--out", remote)
                self.run_terrane(*choice, "--local", "--out", local)
                self.assertTrue(filecmp.cmp(remote, local, shallow=False), (subject, extension))
            pixels = gdal.Open(str(self.folder / "l.png")).ReadAsArray()
            self.assertEqual(pixels.shape, (3, 60, 90))
            self.assertGreater(pixels.std(), 5)
            # Debian's GDAL reads no OpenEXR.
            self.assertEqual((self.folder / "l.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")

    def test_plants_stand_on_a_ground_and_the_rest_does_not(self):
        def picture(preset, *options):
            out = self.folder / "ground.png"
            self.run_terrane("render", "--preset", preset, "--style", "traced", "--local", "--width", "60", "--height", "45",
                             "--passes", "2", *options, "--out", out)
            return out.read_bytes()

        for preset, usual, other in [
            ("flower/daisy", "--ground", "--no-ground"),
            ("tree/plain", "--ground", "--no-ground"),
            ("surface/fig07", "--no-ground", "--ground"),
        ]:
            self.assertEqual(picture(preset), picture(preset, usual), preset)
            self.assertNotEqual(picture(preset), picture(preset, other), preset)

    def test_interrupt_ends_a_traced_picture(self):
        process = subprocess.Popen(
            [TERRANE, "render", "--preset", "surface/fig07", "--style", "traced", "--passes", "4096", "--server",
             self.address, "--progress", "json", "--out", str(self.folder / "long.png")],
            stderr=subprocess.PIPE,
            text=True,
        )
        self.assertIn('"rendered"', process.stderr.readline())
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130, errors)
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
