#!/usr/bin/python3
"""HAProxy in front of real servers: floods end at the proxy, and a replica may die.

Usage: proxy_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import filecmp
import json
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import types
import unittest

from hyperframe import frame as frames

from fault import FaultTest, TimedTest
from frames_test import ENDLESS_HEADER, STREAM_TILES, frame_bytes
from http2 import Http2Client, grpc_message
from real_server import TERRANE, endless_request, fnv1a, golden_tile, main, terrain_pb2, wait_until

# Debian keeps it out of other users' paths.
HAPROXY = shutil.which("haproxy") or shutil.which("haproxy", path="/usr/sbin")
CONFIGURATION = """
defaults
  mode http
  timeout connect 2s
  timeout client 30s
  timeout server 30s
  option redispatch
  retries 3
frontend terrane
  bind 127.0.0.1:{port} proto h2
  default_backend replicas
backend replicas
  balance roundrobin
{servers}
"""


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return listener.getsockname()[1]


def answers(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def start_proxy(test, *servers):
    """HAProxy before `servers`; something to connect an Http2Client to."""
    if HAPROXY is None:
        raise unittest.SkipTest("there is no HAProxy: install the package haproxy")
    port = free_port()
    lines = "\n".join(f"  server replica{i} {server.address} proto h2 check inter 200ms fall 1"
                      for i, server in enumerate(servers))
    configuration = tempfile.NamedTemporaryFile("w", prefix="terrane-haproxy-")
    test.addCleanup(configuration.close)
    configuration.write(CONFIGURATION.format(port=port, servers=lines))
    configuration.flush()
    proxy = subprocess.Popen([HAPROXY, "-db", "-f", configuration.name], stderr=subprocess.DEVNULL)
    test.addCleanup(proxy.wait)
    test.addCleanup(proxy.kill)
    test.assertTrue(wait_until(lambda: answers(port)), "HAProxy does not start")
    return types.SimpleNamespace(host="127.0.0.1", port=port, address=f"127.0.0.1:{port}")


class Floods(FaultTest):
    """The contract: the backend grows by 50 MB at most."""

    MOST_BYTES = 50 << 20

    def setUp(self):
        super().setUp()
        self.proxy = start_proxy(self, self.server)

    def connect(self, timeout=10):
        client = Http2Client(self.proxy, timeout=timeout)
        self.addCleanup(client.close)
        return client

    def assert_proxied(self):
        request, digest = golden_tile()
        answer, trailers = self.connect().call(STREAM_TILES, request.SerializeToString())
        self.assertEqual(trailers["grpc-status"], "0")
        size = int.from_bytes(answer[1:5], "big")
        self.assertEqual(fnv1a(terrain_pb2.StreamTilesResponse.FromString(answer[size + 10:]).tile.data), digest)

    def test_a_continuation_flood_ends_at_the_proxy(self):
        self.assert_proxied()
        sent = 0
        try:
            client = self.connect(timeout=1)
            client.send(frames.HeadersFrame(1, client.header_block(STREAM_TILES)))
            while sent < 64 << 20:
                client.send_raw(frame_bytes(9, 0, 1, ENDLESS_HEADER) * 64)
                sent += 64 * len(ENDLESS_HEADER)
        except (ConnectionError, TimeoutError):
            pass
        self.assertLess(sent, 8 << 20)
        self.assert_memory_flat(self.MOST_BYTES)
        self.assert_proxied()

    def test_a_rapid_reset_ends_at_the_proxy(self):
        self.assert_proxied()
        message = grpc_message(endless_request().SerializeToString())
        opened = 0
        for _ in range(4):
            client = self.connect(timeout=1)
            block = client.header_block(STREAM_TILES)
            try:
                for stream in range(1, 20_001, 2):
                    client.send(frames.HeadersFrame(stream, block, flags=["END_HEADERS"]),
                                frames.DataFrame(stream, message, flags=["END_STREAM"]),
                                frames.RstStreamFrame(stream, error_code=8))
                    opened += 1
            except (ConnectionError, TimeoutError):
                pass
            self.assert_memory_flat(self.MOST_BYTES)
            client.abort()
        self.assertGreater(opened, 1000)
        self.assert_proxied()


class Replicas(TimedTest):
    CHOICE = ["terrain", "--seed", "11", "--level", "30", "--window", "0,0,4096,4096", "--tile-size", "256"]

    def test_a_replica_killed_mid_stream_changes_no_byte(self):
        replicas = [self.start_server("--workers", "1") for _ in range(2)]
        proxy = start_proxy(self, *replicas)
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        client = subprocess.Popen([TERRANE, *self.CHOICE, "--server", proxy.address, "--out", folder / "out.f32",
                                   "--progress", "json"], stderr=subprocess.PIPE, text=True)
        self.addCleanup(client.stderr.close)
        self.addCleanup(client.kill)
        json.loads(client.stderr.readline())  # the first tile has come
        busy, idle = sorted(replicas, key=lambda replica: replica.cpu_seconds(), reverse=True)
        busy.process.send_signal(signal.SIGKILL)
        busy.process.wait(5)
        self.assertIsNone(client.poll())
        self.assertEqual(client.wait(15), 0)
        resumed = [call["tiles"] for call in idle.calls() if call.get("tiles")]
        self.assertTrue(resumed and max(resumed) < 256, resumed)  # only what was missing
        subprocess.run([TERRANE, *self.CHOICE, "--local", "--out", folder / "alone.f32"], check=True, capture_output=True)
        self.assertTrue(filecmp.cmp(folder / "out.f32", folder / "alone.f32", shallow=False))


if __name__ == "__main__":
    main()
