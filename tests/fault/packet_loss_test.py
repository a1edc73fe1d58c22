#!/usr/bin/python3
"""A network that loses every fifth packet: the right bytes, or a clean error.

Usage: packet_loss_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import filecmp
import pathlib
import subprocess
import tempfile
import time
import unittest

from fault import TimedTest
from lossy_link import LossyLink, NoNamespaces
from real_server import PATIENCE_SECONDS, TERRANE, main

CHOICE = ["terrain", "--seed", "21", "--level", "12", "--window", "0,0,192,160", "--tile-size", "32"]


class PacketLoss(TimedTest):
    def setUp(self):
        super().setUp()
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def lossy_link(self, loss):
        try:
            return self.enterContext(LossyLink(loss))
        except NoNamespaces as reason:
            self.skipTest(f"no network namespaces here: {reason}")

    def server_on(self, link):
        return self.start_server("--insecure", listen=f"{link.NEAR_ADDRESS}:0", wrapper=link.command_in(link.near))

    def ask(self, link, server, out, timeout):
        """The client at the far end: its exit code, nothing when it was ended after `timeout` seconds."""
        command = [*link.command_in(link.far), TERRANE, *CHOICE, "--server", server.address, "--out", out]
        try:
            return subprocess.run(command, capture_output=True, timeout=timeout).returncode
        except subprocess.TimeoutExpired:
            return None

    def test_every_fifth_packet_is_lost(self):
        subprocess.run([TERRANE, *CHOICE, "--local", "--out", self.folder / "alone.f32"], check=True, capture_output=True)
        link = self.lossy_link(0.2)
        server = self.server_on(link)
        right, end = 0, time.monotonic() + PATIENCE_SECONDS
        while time.monotonic() < end and (right < 1 or link.lost <= 20):
            out = self.folder / "out.f32"
            code = self.ask(link, server, out, max(end - time.monotonic(), 1))
            if code == 0:
                self.assertTrue(filecmp.cmp(out, self.folder / "alone.f32", shallow=False))
                out.unlink()
                right += 1
            else:
                self.assertFalse(out.exists())
                self.assertIn(code, {None, 1, 4})
        self.assertGreater(link.lost, 20)
        self.assertAlmostEqual(link.lost / (link.lost + link.carried), 0.2, delta=0.1)
        self.assertGreater(right, 0, "nothing came through")
        self.assertTrue(server.alive())
        # The link is whole again, and so is what comes over it.
        link.loss = 0
        self.assertEqual(self.ask(link, server, self.folder / "after.f32", PATIENCE_SECONDS), 0)
        self.assertEqual(server.end(), 0)

    def test_a_link_that_is_cut_ends_in_an_error(self):
        link = self.lossy_link(0)
        server = self.server_on(link)
        self.assertEqual(self.ask(link, server, self.folder / "whole.f32", PATIENCE_SECONDS), 0)
        link.loss = 1
        out = self.folder / "cut.f32"
        self.assertEqual(self.ask(link, server, out, PATIENCE_SECONDS), 4)
        self.assertFalse(out.exists())
        self.assertTrue(server.alive())


if __name__ == "__main__":
    main()
