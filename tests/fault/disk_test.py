#!/usr/bin/python3
"""Disks that fill up while heights are written: an error, whole files or none, and another go.

Usage: disk_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import os
import pathlib
import subprocess
import tempfile
import unittest

from fault import TimedTest
from real_server import TERRANE, main

# In a mount namespace of its own, so that nothing is left of it: ARGUMENTS into a disk
# of a quarter of a megabyte, then, with room enough, again. FOLDER/full and FOLDER/again are what
# lay on the disk each time.
SCRIPT = r"""
folder="$1"; out="$2"; shift 2
mkdir "${folder}/disk"
mount -t tmpfs -o size=256k tmpfs "${folder}/disk"
"$@" --out "${folder}/disk/${out}"
echo "$?" >"${folder}/full.code"
cp -r "${folder}/disk" "${folder}/full"
mount -o remount,size=64m "${folder}/disk"
"$@" --out "${folder}/disk/${out}"
echo "$?" >"${folder}/again.code"
cp -r "${folder}/disk" "${folder}/again"
"""
NAMESPACE = ["unshare", "--mount"] if os.geteuid() == 0 else ["unshare", "--user", "--map-root-user", "--mount"]


def contents(folder):
    """The bytes of each file in a folder, whatever is hidden included."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


class FullDisk(TimedTest):
    @classmethod
    def setUpClass(cls):
        tried = subprocess.run([*NAMESPACE, "mount", "-t", "tmpfs", "tmpfs", "/mnt"], capture_output=True, text=True)
        if tried.returncode != 0:
            raise unittest.SkipTest("no mount namespace for a disk of one's own: " + tried.stderr.strip())

    def fill(self, out, *arguments):
        """Runs into a full disk; the exit code, what was left, and what came of another go with room."""
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        done = subprocess.run([*NAMESPACE, "sh", "-c", SCRIPT, "sh", folder, out, TERRANE, *arguments],
                              capture_output=True, text=True)
        self.assertIn("No space left on device", done.stderr)
        full, again = (int((folder / f"{name}.code").read_text()) for name in ("full", "again"))
        self.assertEqual(again, 0, done.stderr)
        return full, contents(folder / "full"), contents(folder / "again")

    def reference(self, out, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([TERRANE, *arguments, "--out", os.path.join(folder, out)], check=True, capture_output=True)
            return contents(pathlib.Path(folder))

    def check_one_file(self, extension):
        choice = ["terrain", "--local", "--seed", "3", "--level", "9", "--window", "0,0,400,400", "--compress", "none"]
        code, left, again = self.fill(f"x.{extension}", *choice)
        self.assertEqual((code, left), (1, {}))
        self.assertEqual(again, self.reference(f"x.{extension}", *choice))

    def check_tiles(self, extension, tile_size):
        choice = ["terrain", "--local", "--seed", "3", "--level", "9", "--tiles", "0,0,3,2", "--range=-9,9",
                  "--tile-size", tile_size]
        code, left, again = self.fill(f"x.{extension}", *choice)
        whole = self.reference(f"x.{extension}", *choice)
        self.assertEqual(code, 3)
        self.assertTrue(0 < len(left) < len(whole), left.keys())
        self.assertLessEqual(left.items(), whole.items())
        self.assertEqual(again, whole)

    def test_an_export_goes_on_where_the_disk_was_full(self):
        choice = ["export", "--local", "--seed", "3", "--level", "9", "--tiles", "0,0,3,2", "--tile-size", "151"]
        code, left, again = self.fill("x.f32", *choice)
        whole = self.reference("x.f32", *choice)
        self.assertEqual(code, 3)
        manifest = "x.f32.shard-0-of-1.json"
        tiles_left = {name: data for name, data in left.items() if name != manifest}
        self.assertTrue(tiles_left)
        self.assertLess(tiles_left.items(), whole.items())
        self.assertEqual(again, whole)

    def test_one_tif_is_whole_or_not_there(self):
        self.check_one_file("tif")

    def test_one_f32_is_whole_or_not_there(self):
        self.check_one_file("f32")

    def test_one_r16_is_whole_or_not_there(self):
        self.check_one_file("r16")

    def test_one_png_is_whole_or_not_there(self):
        self.check_one_file("png")

    def test_one_exr_is_whole_or_not_there(self):
        self.check_one_file("exr")

    def test_tiles_of_tif_that_are_there_are_whole(self):
        self.check_tiles("tif", "151")

    def test_tiles_of_f32_that_are_there_are_whole(self):
        self.check_tiles("f32", "151")

    def test_tiles_of_r16_that_are_there_are_whole(self):
        self.check_tiles("r16", "181")


if __name__ == "__main__":
    main()
