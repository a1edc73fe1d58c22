#!/usr/bin/python3
"""Floods of connections, and connections that misbehave, against the real server.

Usage: connections_test.py TERRANE_SERVER STUBS [unittest arguments]
"""

import contextlib
import os
import pathlib
import resource
import socket
import sys
import tempfile
import time
import unittest

import grpc
from grpc import StatusCode

from real_server import INFO, all_methods, call, endless, served

SERVER, STUBS = sys.argv[1:3]
all_methods(STUBS)


def descriptors(server):
    """How many descriptors the server has open."""
    return len(os.listdir(f"/proc/{server.process.pid}/fd"))


def cpu_seconds(server):
    """The time that the server has run on a CPU."""
    fields = pathlib.Path(f"/proc/{server.process.pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def established(server):
    """How many connections the server has, by the kernel's list."""
    lines = pathlib.Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()[1:]
    entries = [line.split() for line in lines]
    return sum(int(local.split(":")[1], 16) == server.port and state == "01" for _, local, _, state, *_ in entries)


@contextlib.contextmanager
def flood(server, count):
    """That many connections that say nothing."""
    sockets = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(count)]
    try:
        yield sockets
    finally:
        for connection in sockets:
            connection.close()


def is_open(connection):
    """Whether the server has not closed a connection that says nothing."""
    connection.setblocking(False)
    try:
        return connection.recv(1 << 16) != b""
    except BlockingIOError:
        return True
    except ConnectionError:
        return False


def open_channel(server, *options):
    """A channel with a connection of its own."""
    return grpc.insecure_channel(server.address, options=[("grpc.use_local_subchannel_pool", 1), *options])


class ConnectionsTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def served(self, *flags, **options):
        return served(SERVER, self.folder, *flags, **options)

    def eventually(self, condition, text):
        deadline = time.monotonic() + 15
        while not condition():
            self.assertLess(time.monotonic(), deadline, text)
            time.sleep(0.05)

    def answers(self, server):
        with open_channel(server) as channel:
            return call(channel, INFO)[0] == StatusCode.OK

    def test_a_flood_is_capped_and_leaves_nothing_behind(self):
        with self.served("--max-connections", 20) as server:
            before = descriptors(server)
            with open_channel(server) as early, flood(server, 200) as sockets:
                self.eventually(lambda: sum(map(is_open, sockets)) < 20, "the cap is not kept")
                # Who was there before goes on; who comes now is turned away at once.
                self.assertEqual(call(early, INFO)[0], StatusCode.OK)
                self.assertLessEqual(descriptors(server), before + 2 * 20 + 5)
            self.eventually(lambda: self.answers(server), "the places are not free again")
            self.eventually(lambda: descriptors(server) <= before + 2, "descriptors are left open")

    def test_the_cap_stays_below_the_limit_of_descriptors(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_NOFILE, (96, 96))
        with self.served(preexec_fn=limit) as server:
            # The log is written by a thread of its own.
            self.eventually(lambda: "connections limited" in server.log(), "the limit is not said")
            with flood(server, 300) as sockets:
                self.eventually(lambda: sum(map(is_open, sockets)) <= 24, "the cap is not kept")
                self.assertLess(descriptors(server), 96)
            self.eventually(lambda: self.answers(server), "the server does not recover")

    def test_out_of_descriptors_it_waits_and_recovers(self):
        with self.served() as server:
            self.assertTrue(self.answers(server))
            _, most = resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE)
            resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (3, most))
            with flood(server, 30):
                used = cpu_seconds(server)
                time.sleep(1)
                self.assertLess(cpu_seconds(server) - used, 0.3)
            resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (most, most))
            self.eventually(lambda: self.answers(server), "the server does not recover")

    def test_a_connection_that_says_nothing_is_closed(self):
        with self.served() as server, flood(server, 3) as sockets:
            self.eventually(lambda: not any(map(is_open, sockets)), "silent connections stay")

    def test_floods_of_pings_end_the_connection_ordinary_ones_do_not(self):
        with self.served() as server:
            def pinged(milliseconds):
                return open_channel(server, ("grpc.keepalive_time_ms", milliseconds), ("grpc.http2.max_pings_without_data", 0),
                                    ("grpc.http2.min_time_between_pings_ms", 10))
            with pinged(6_000) as calm, pinged(100) as hasty:
                streams = [endless(channel) for channel in (calm, hasty)]
                # Nobody reads, so that only pings go over the connections.
                time.sleep(13)
                codes = []
                for stream in streams:
                    try:
                        for _ in range(200):
                            next(stream)
                        codes.append(StatusCode.OK)
                    except grpc.RpcError as error:
                        codes.append(error.code())
                self.assertEqual(codes, [StatusCode.OK, StatusCode.UNAVAILABLE])
                streams[0].cancel()

    def test_an_old_connection_takes_no_new_call(self):
        with self.served("--max-connection-age-seconds", 1) as server, open_channel(server) as channel:
            stream = endless(channel)
            counts = [established(server)]
            for _ in range(15):
                self.assertEqual(call(channel, INFO)[0], StatusCode.OK)
                counts.append(established(server))
                time.sleep(0.2)
            # The old connection still carries its stream, others the calls, until they are old, too.
            self.assertEqual(counts[0], 1)
            self.assertGreater(max(counts), 1)
            next(stream)
            stream.cancel()

    def test_a_drain_takes_no_connection_and_lets_streams_end(self):
        with self.served() as server, open_channel(server) as channel:
            stream = endless(channel)
            server.drain()

            def is_refused():
                try:
                    socket.create_connection(("127.0.0.1", server.port)).close()
                    return False
                except ConnectionRefusedError:
                    return True
            self.eventually(is_refused, "the port is still open")
            for _ in range(20):
                next(stream)
            self.assertIsNone(server.process.poll())
            stream.cancel()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
