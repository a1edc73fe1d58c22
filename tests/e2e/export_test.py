#!/usr/bin/python3
"""`terrane export`: shards, resuming, verifying.

Usage: export_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))

from real_server import RealServer, TERRANE, main, wait_until  # noqa: E402

CHOICE = ["--level", "7", "--tile-size", "33"]
TILES = ["--tiles", "-2,3,5,4"]


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = RealServer("--workers", "2")

    @classmethod
    def tearDownClass(cls):
        cls.server.kill()

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def run_terrane(self, *arguments, expected=0, command="export"):
        done = subprocess.run([TERRANE, command, *map(str, arguments)], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, expected, done.stderr)
        return done

    def export(self, out, *arguments, expected=0):
        """Exports with the server; what --json says."""
        done = self.run_terrane(*CHOICE, *TILES, "--out", self.folder / out, "--server", self.server.address, "--json",
                                *arguments, expected=expected)
        return json.loads(done.stdout) if done.stdout else done.stderr

    def tiles(self, folder):
        """Every file that is no manifest, by name: its bytes."""
        return {path.name: path.read_bytes() for path in (self.folder / folder).iterdir() if ".shard-" not in path.name}

    def test_shards_together_write_what_one_writes(self):
        for extension in ("tif", "f32", "exr", "png", "r16"):
            with self.subTest(extension):
                whole, parts = f"whole-{extension}", f"parts-{extension}"
                self.assertEqual(self.export(f"{whole}/tile.{extension}", "--range=-9,9")["made"], 20)
                made = []
                with concurrent.futures.ThreadPoolExecutor(3) as pool:
                    shards = [pool.submit(self.export, f"{parts}/tile.{extension}", "--range=-9,9", "--shards", 3,
                                          "--shard", shard) for shard in range(3)]
                    made = [shard.result()["made"] for shard in shards]
                self.assertEqual(made, [7, 7, 6])
                self.assertEqual(self.tiles(parts), self.tiles(whole))
                # And `terrane terrain` cuts the same tiles.
                cut = self.folder / f"cut-{extension}"
                self.run_terrane(*CHOICE, *TILES, "--local", "--range=-9,9", "--out", cut / f"tile.{extension}",
                                 command="terrain")
                self.assertEqual(self.tiles(cut.name), self.tiles(whole))

    def test_the_manifest_names_what_is_there(self):
        summary = self.export("a/tile.f32", "--shards", 2, "--shard", 1)
        (path,) = summary["manifests"]
        self.assertEqual(path, str(self.folder / "a" / "tile.f32.shard-1-of-2.json"))
        manifest = json.loads(pathlib.Path(path).read_text())
        self.assertEqual([(tile["x"], tile["y"]) for tile in manifest["tiles"]],
                         [(x, y) for y in (5, 6) for x in range(-2, 3)])
        listed = {file["file"]: file for tile in manifest["tiles"] for file in tile["files"]}
        there = self.tiles("a")
        self.assertEqual(listed.keys(), there.keys())
        for name, data in there.items():
            self.assertEqual((listed[name]["bytes"], listed[name]["sha256"]), (len(data), hashlib.sha256(data).hexdigest()))
        self.assertEqual((manifest["job"]["recipe_hash"], manifest["shard"]), (summary["recipe_hash"], 1))

    def test_only_what_is_missing_is_made_again(self):
        self.export("a/tile.f32")
        before = self.tiles("a")
        times = {path: path.stat().st_mtime_ns for path in (self.folder / "a").glob("*.f32")}
        self.assertEqual(self.export("a/tile.f32")["made"], 0)
        (self.folder / "a" / "tile_x0_y4.f32").unlink()
        (self.folder / "a" / "tile_x1_y6.f32.json").unlink()
        (self.folder / "a" / "tile_x-1_y3.f32").write_bytes(b"damaged")
        again = self.export("a/tile.f32")
        self.assertEqual((again["made"], again["kept"]), (3, 17))
        self.assertEqual(self.tiles("a"), before)
        touched = {path.name for path, time in times.items() if path.stat().st_mtime_ns != time}
        self.assertEqual(touched, {"tile_x0_y4.f32", "tile_x1_y6.f32", "tile_x-1_y3.f32"})

    def test_another_job_is_not_taken_for_this_one(self):
        self.export("a/tile.f32")
        seeded = self.export("a/tile.f32", "--seed", 77)
        self.assertEqual(seeded["made"], 20)
        (self.folder / "a" / "tile.f32.shard-0-of-1.json").write_text("{ no JSON")
        self.assertEqual(self.export("a/tile.f32", "--seed", 77)["made"], 20)

    def test_verify_says_what_is_missing(self):
        out = self.folder / "a" / "tile.f32"
        for shard in (0, 2):
            self.export("a/tile.f32", "--shards", 3, "--shard", shard)
        failed = self.run_terrane("--verify", "--out", out, "--shards", 3, expected=3)
        self.assertIn("tile.f32.shard-1-of-3.json", failed.stderr)
        self.export("a/tile.f32", "--shards", 3, "--shard", 1)
        verified = self.run_terrane("--verify", "--out", out, "--shards", 3, "--json")
        self.assertEqual(json.loads(verified.stdout)["tiles"], 20)
        (self.folder / "a" / "tile_x0_y4.f32").write_bytes(b"damaged")
        failed = self.run_terrane("--verify", "--out", out, "--shards", 3, expected=3)
        self.assertIn("tile 0,4 is not there as it was made", failed.stderr)
        self.export("a/tile.f32", "--shards", 3, "--shard", 2, "--seed", 5)
        failed = self.run_terrane("--verify", "--out", out, "--shards", 3, expected=3)
        self.assertIn("of another job", failed.stderr)

    def test_two_formats_in_one_folder_are_two_exports(self):
        self.export("a/tile.f32")
        failed = self.run_terrane("--verify", "--out", self.folder / "a" / "tile.tif", expected=3)
        self.assertIn("cannot read", failed.stderr)
        self.export("a/tile.tif")
        for extension in ("f32", "tif"):
            self.run_terrane("--verify", "--out", self.folder / "a" / f"tile.{extension}")
            self.assertEqual(self.export(f"a/tile.{extension}")["made"], 0)

    def test_an_interrupted_shard_goes_on_where_it_was(self):
        choice = ["--seed", 4, "--level", 30, "--tiles", "0,0,60,60", "--tile-size", 65, "--out", self.folder / "a" / "t.f32",
                  "--server", self.server.address]
        process = subprocess.Popen([TERRANE, "export", *map(str, choice), "--progress", "json"], stderr=subprocess.PIPE,
                                   stdout=subprocess.DEVNULL, text=True)
        process.stderr.readline()
        # It cannot come to its end before the signal does.
        self.server.process.send_signal(signal.SIGSTOP)
        try:
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(60), 130)
        finally:
            self.server.process.send_signal(signal.SIGCONT)
        process.stderr.close()
        self.assertEqual([path.name for path in (self.folder / "a").iterdir() if path.name.startswith(".")], [])
        summary = json.loads(self.run_terrane(*choice, "--json").stdout)
        self.assertGreater(summary["kept"], 0)
        self.assertGreater(summary["made"], 0)
        self.assertEqual(summary["tiles"], 3600)
        self.run_terrane("--verify", "--out", self.folder / "a" / "t.f32")

    def test_verify_and_resume_are_interrupted_while_they_hash(self):
        self.export("a/tile.f32")
        manifest = (self.folder / "a" / "tile.f32.shard-0-of-1.json").read_bytes()
        first = self.folder / "a" / "tile_x-2_y3.f32"
        first.unlink()
        os.mkfifo(first)
        out = ["--out", str(self.folder / "a" / "tile.f32")]
        for arguments in (["--verify", *out], [*CHOICE, *TILES, *out, "--server", self.server.address]):
            with self.subTest(arguments):
                process = subprocess.Popen([TERRANE, "export", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                with open(first, "wb"):  # once it reads there
                    process.send_signal(signal.SIGINT)
                    self.assertTrue(wait_until(lambda: not self.is_pending(process, signal.SIGINT), 60))
                    time.sleep(0.5)  # from the signal to what it is to do
                _, error = process.communicate(timeout=60)
                self.assertEqual((process.returncode, error), (130, b"terrane: interrupted\n"))
        self.assertEqual((self.folder / "a" / "tile.f32.shard-0-of-1.json").read_bytes(), manifest)

    def is_pending(self, process, number):
        """Whether a signal to a process waits for somebody to take it."""
        with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
            (mask,) = [int(line.split()[1], 16) for line in status if line.startswith("ShdPnd:")]
        return mask >> (number - 1) & 1 == 1

    def test_local_has_as_many_threads_as_the_quota_leaves(self):
        # In a mount namespace of its own, control groups with a quota where the kernel's would be.
        mount = "mount -t tmpfs tmpfs /sys/fs/cgroup"
        run = mount + ' && echo "$1 100000" >/sys/fs/cgroup/cpu.max && exec "$2" info --local --json'
        tried = subprocess.run(["unshare", "--mount", "sh", "-c", mount], capture_output=True, text=True)
        if tried.returncode != 0:
            self.skipTest("no mount namespace for control groups of one's own: " + tried.stderr.strip())
        for quota, expected in [("50000", 1), ("max", len(os.sched_getaffinity(0)))]:
            with self.subTest(quota):
                done = subprocess.run(["unshare", "--mount", "sh", "-c", run, "sh", quota, TERRANE], capture_output=True,
                                      text=True, timeout=120, check=True)
                self.assertEqual(json.loads(done.stdout)["workers"], expected)

    def test_usage_errors_name_the_option(self):
        for arguments, expected in [
                (["--shards", 4, "--shard", 4], "--shard: must be 0 to 3, got 4"),
                (["--shards", 0], "--shards"),
                (["--shard", -1], "--shard"),
                (["--tiles", "0,0,0,3"], "--tiles: COLUMNS and ROWS must be at least 1, got 0,3"),
                (["--tiles", "0,0,9999999,9999999"], "--shards: a shard makes at most 100000 tiles"),
                (["--tiles", "1,2,3"], "--tiles: must be all or X,Y,COLUMNS,ROWS"),
                (["--out", "tile.png"], "--range: must be given for .png and .r16"),
                (["--out", "tile.jpg"], "--out: must end in"),
                (["--out", "{y}/{x}.tif"], "--out: {x} and {y} belong into the name"),
        ]:
            with self.subTest(arguments=arguments):
                given = arguments if "--tiles" in arguments else [*TILES, *arguments]
                given = given if "--out" in given else [*given, "--out", self.folder / "x.tif"]
                done = self.run_terrane(*CHOICE, "--local", *given, expected=2)
                self.assertIn(expected, done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_shards_without_tiles_are_done_at_once(self):
        for shard in range(3):
            self.run_terrane(*CHOICE, "--local", "--tiles", "0,0,2,1", "--shards", 3, "--shard", shard, "--out",
                             self.folder / "tile.tif")
        self.run_terrane("--verify", "--out", self.folder / "tile.tif", "--shards", 3)
        self.assertEqual(len(self.tiles(".")), 2)


if __name__ == "__main__":
    main()
