#!/usr/bin/python3
"""Connections that break HTTP/2, by hand-made frames: see fault.py for what must hold after it.

Usage: frames_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import random
import ssl
import time

from hyperframe import frame as frames

from fault import FaultTest
from http2 import Http2Client, PREFACE
from real_server import HEALTH_CHECK, PATIENCE_SECONDS, SERVING, fnv1a, golden_tile, main, terrain_pb2

STREAM_TILES = "/terrane.v1.TerrainService/StreamTiles"
# What memory may grow by under attack: buffers of one connection, not what was sent.
FLAT_BYTES = 32 << 20
ATTACK_BYTES = 32 << 20
# More than the kernel takes for a server that reads none of it.
READ_BYTES = 8 << 20
# A header field of a kilobyte, as HPACK writes one that no table holds.
ENDLESS_HEADER = b"\x00\x06x-evil\x7f\x81\x07" + bytes(1024)


def frame_bytes(kind, flags, stream, body):
    """A frame of any kind, right or wrong."""
    return len(body).to_bytes(3, "big") + bytes([kind, flags]) + stream.to_bytes(4, "big") + body


class BrokenConnections(FaultTest):
    def connect(self, **options):
        client = Http2Client(self.server, **options)
        self.addCleanup(client.close)
        return client

    def flood(self, client, data):
        """Sends `data` again and again until the server cuts the connection or has had enough of it, and
        it must have read some of it; how much was sent."""
        sent, is_cut, end = 0, False, time.monotonic() + PATIENCE_SECONDS
        client.socket.settimeout(1)
        while sent < ATTACK_BYTES and not is_cut:
            try:
                sent += client.socket.send(data[sent % len(data):])
            except ConnectionError:
                is_cut = True
            except TimeoutError:
                if sent >= READ_BYTES or time.monotonic() > end:
                    break
        client.socket.settimeout(PATIENCE_SECONDS)
        self.assertTrue(is_cut or sent >= READ_BYTES, f"of {sent} bytes the server read none, perhaps")
        return sent

    def assert_served_on(self, client):
        """The golden tile over that very connection."""
        request, digest = golden_tile()
        answer, trailers = client.call(STREAM_TILES, request.SerializeToString())
        self.assertEqual(trailers["grpc-status"], "0")
        size = int.from_bytes(answer[1:5], "big")  # the header comes first
        tile = terrain_pb2.StreamTilesResponse.FromString(answer[size + 10:]).tile
        self.assertEqual(fnv1a(tile.data), digest)

    def test_a_right_connection_is_served(self):
        """What the others vary works when it is right."""
        client = self.connect()
        answer, trailers = client.call(HEALTH_CHECK, b"")
        self.assertEqual((answer[5:], trailers["grpc-status"]), (SERVING, "0"))
        self.assert_served_on(client)

    def test_what_is_no_preface_is_cut(self):
        noise = random.Random(3)
        hello = ssl.MemoryBIO()
        tls = ssl.create_default_context().wrap_bio(ssl.MemoryBIO(), hello, server_hostname="localhost")
        with self.assertRaises(ssl.SSLWantReadError):
            tls.do_handshake()
        for preface in [b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", hello.read(), noise.randbytes(5000), bytes(5000),
                        PREFACE[:-1] + b"X" + bytes(100), b"PRI * HTTP/2.0\r\n\r\nXX\r\n\r\n" + bytes(100)]:
            with self.subTest(preface=preface[:20]):
                self.assertTrue(self.connect(preface=preface).is_cut())

    def test_half_a_preface_holds_nobody_up(self):
        silent = [self.connect() for _ in range(50)]
        for client in silent:
            client.send_raw(frame_bytes(0, 0, 1, b"")[:5])
        self.assert_golden()
        self.assert_memory_flat(FLAT_BYTES)

    def test_frames_of_unknown_kinds_are_ignored(self):
        client = self.connect()
        noise = random.Random(4)
        for kind in (0x0B, 0x42, 0xFF):
            client.send_raw(frame_bytes(kind, noise.randrange(256), noise.choice([0, 1, 7]), noise.randbytes(900)))
        self.assert_served_on(client)

    def test_frames_that_break_the_rules_cut_the_connection(self):
        rules = {
            "frame above the announced size": frame_bytes(0, 0, 1, bytes(1 << 20)),
            "settings of 5 bytes": frame_bytes(4, 0, 0, b"12345"),
            "ping of 3 bytes": frame_bytes(6, 0, 0, b"123"),
            "window update of 2 bytes": frame_bytes(8, 0, 0, b"12"),
            "continuation of nothing": frame_bytes(9, 4, 1, b"\x82"),
        }
        for name, data in rules.items():
            with self.subTest(name):
                client = self.connect()
                client.send_raw(data)
                self.assertTrue(client.is_cut(), name)

    def test_frames_of_streams_that_are_not_there_are_outlived(self):
        """gRPC ignores some of what RFC 9113 calls an error of the connection."""
        for data in [frame_bytes(0, 0, 0, b"data"), frame_bytes(1, 4, 0, b"\x82"), frame_bytes(1, 4, 2, b"\x82"),
                     frame_bytes(0, 0, 77, b"data"), frame_bytes(3, 0, 77, bytes(4)),
                     frame_bytes(1, 4, 1, b"\xff" * 40)]:
            client = self.connect()
            client.send_raw(data)
            self.assert_golden()

    def test_floods_of_small_frames_stay_out_of_memory(self):
        floods = {
            "settings": frame_bytes(4, 0, 0, b"\x00\x04" + (70_000).to_bytes(4, "big")),
            "window updates": frame_bytes(8, 0, 0, b"\x00\x00\x00\x01"),
            "empty data": frame_bytes(0, 0, 1, b""),
            "priorities": frame_bytes(2, 0, 1, bytes(5)),
            "unknown frames": frame_bytes(0x42, 0, 1, bytes(1000)),
        }
        for name, data in floods.items():
            with self.subTest(name):
                client = self.connect()
                self.flood(client, data * (65_536 // len(data)))
                self.assert_memory_flat(FLAT_BYTES)
                self.assert_golden()
                client.abort()

    def test_a_flood_of_empty_continuations_stays_out_of_memory(self):
        client = self.connect()
        client.send_raw(frame_bytes(1, 0, 1, b""))
        self.flood(client, frame_bytes(9, 0, 1, b"") * 7000)
        self.assert_memory_flat(FLAT_BYTES)
        self.assert_golden()

    def test_a_ping_flood_is_cut(self):
        client = self.connect()
        # Their answers are kept until they are read, which this client does not.
        self.assertLess(self.flood(client, frame_bytes(6, 0, 0, bytes(8)) * 4000), ATTACK_BYTES)
        self.assertTrue(client.is_cut())

    def test_a_continuation_flood_takes_no_more_than_it_sends(self):
        """gRPC 1.51 keeps headers that never end (CVE-2023-33953). Behind the proxy nothing comes of
        it (tests/deploy/haproxy_test.py); without one it costs what the client sends, and only as long as it is there.
        """
        self.memory_margin_bytes = 8 * ATTACK_BYTES  # the allocator gives little of it back
        for _ in range(3):
            client = self.connect()
            client.send(frames.HeadersFrame(1, client.header_block(STREAM_TILES)))
            sent = self.flood(client, frame_bytes(9, 0, 1, ENDLESS_HEADER) * 64)
            self.assert_memory_flat(4 * sent + FLAT_BYTES)
            self.assert_golden()
            client.abort()


if __name__ == "__main__":
    main()
