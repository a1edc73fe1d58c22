#!/usr/bin/python3
"""Probes and metrics of the real server, as Python's own HTTP client sees them.

Usage: monitoring_test.py TERRANE_SERVER OPERATIONS_MD [unittest arguments]
"""

import http.client
import pathlib
import re
import signal
import subprocess
import sys
import unittest

SERVER, OPERATIONS = sys.argv[1:3]
# What comes at once on a quiet machine may take as long on one that others use.
PATIENCE_SECONDS = 60


def start(*flags):
    return subprocess.Popen([SERVER, "--listen", "127.0.0.1:0", *flags], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


class MonitoringTest(unittest.TestCase):
    """A server with --http-listen on a port of its choice."""

    def setUp(self):
        self.server = start("--http-listen", "127.0.0.1:0", "--memory-limit-mib", "4096", "--workers", "3")
        self.addCleanup(self.end)
        self.lines = [self.server.stdout.readline() for _ in range(2)]
        self.port = int(self.lines[1].rpartition(":")[2])

    def end(self):
        self.server.kill()
        self.server.communicate()

    def get(self, path):
        """Status, content type and text of a page."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_SECONDS)
        connection.request("GET", path)
        reply = connection.getresponse()
        return reply.status, reply.getheader("Content-Type"), reply.read().decode()

    def test_ports_are_two_lines(self):
        self.assertRegex(self.lines[0], r"\Alistening on 127\.0\.0\.1:[1-9]\d*\n\Z")
        self.assertRegex(self.lines[1], r"\Ahttp on 127\.0\.0\.1:[1-9]\d*\n\Z")

    def test_pages(self):
        self.assertEqual(self.get("/livez"), (200, "text/plain; charset=utf-8", "ok\n"))
        self.assertEqual(self.get("/readyz"), (200, "text/plain; charset=utf-8", "ok\n"))
        self.assertEqual(self.get("/")[0], 404)
        status, kind, text = self.get("/metrics")
        self.assertEqual((status, kind), (200, "text/plain; version=0.0.4; charset=utf-8"))
        values = dict(line.rsplit(" ", 1) for line in text.splitlines() if not line.startswith("#"))
        self.assertEqual(float(values["terrane_workers"]), 3)
        self.assertLessEqual(float(values["terrane_memory_limit_bytes"]), 4096 << 20)
        self.assertGreater(float(values["terrane_memory_bytes"]), 1 << 20)

    def test_every_metric_is_documented(self):
        exported = set(re.findall(r"^# TYPE (\S+) ", self.get("/metrics")[2], re.MULTILINE))
        self.assertGreater(len(exported), 10)
        documented = set(re.findall(r"`((?:terrane|process)_\w+)`", pathlib.Path(OPERATIONS).read_text("utf-8")))
        self.assertEqual(exported - documented, set())

    def test_ends_in_order(self):
        self.server.send_signal(signal.SIGTERM)
        self.assertEqual(self.server.wait(timeout=PATIENCE_SECONDS), 0)
        with self.assertRaises(OSError):
            self.get("/livez")


class StartTest(unittest.TestCase):
    """Addresses that cannot be had."""

    def test_taken_port(self):
        first = start("--http-listen", "127.0.0.1:0")
        try:
            address = [first.stdout.readline() for _ in range(2)][1].split()[-1]
            second = start("--http-listen", address)
            _, errors = second.communicate(timeout=PATIENCE_SECONDS)
            self.assertEqual(second.returncode, 1)
            self.assertIn(f"cannot listen on {address}: ", errors)
        finally:
            first.kill()
            first.communicate()

    def test_no_port(self):
        server = start("--http-listen", "127.0.0.1")
        _, errors = server.communicate(timeout=PATIENCE_SECONDS)
        self.assertEqual(server.returncode, 2)
        self.assertIn("--http-listen must be ADDRESS:PORT, got 127.0.0.1", errors)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
