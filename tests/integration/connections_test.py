#!/usr/bin/python3
"""Floods of connections, and connections that misbehave, against the real server.

Usage: connections_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import contextlib
import pathlib
import resource
import socket
import time
import unittest

import grpc
from grpc import StatusCode

from edge import INFO, call, endless
from real_server import is_open, main, served, wait_until


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


class ConnectionsTest(unittest.TestCase):
    def eventually(self, condition, text):
        self.assertTrue(wait_until(condition), text)

    def answers(self, server):
        with server.channel() as channel:
            return call(channel, INFO)[0] == StatusCode.OK

    def test_a_flood_is_capped_and_leaves_nothing_behind(self):
        with served("--max-connections", 20) as server:
            before = server.open_files()
            with server.channel() as early, flood(server, 200) as sockets:
                self.eventually(lambda: sum(map(is_open, sockets)) < 20, "the cap is not kept")
                # Who was there before goes on; who comes now is turned away at once.
                self.assertEqual(call(early, INFO)[0], StatusCode.OK)
                self.assertLessEqual(server.open_files(), before + 2 * 20 + 5)
            self.eventually(lambda: self.answers(server), "the places are not free again")
            self.eventually(lambda: server.open_files() <= before + 2, "descriptors are left open")

    def test_the_cap_stays_below_the_limit_of_descriptors(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_NOFILE, (96, 96))
        with served(preexec_fn=limit) as server:
            # The log is written by a thread of its own.
            self.eventually(lambda: "connections limited" in server.log_text(), "the limit is not said")
            with flood(server, 300) as sockets:
                self.eventually(lambda: sum(map(is_open, sockets)) <= 24, "the cap is not kept")
                self.assertLess(server.open_files(), 96)
            self.eventually(lambda: self.answers(server), "the server does not recover")

    def test_out_of_descriptors_it_waits_and_recovers(self):
        with served() as server:
            self.assertTrue(self.answers(server))
            _, most = resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE)
            resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (3, most))
            with flood(server, 30):
                self.eventually(server.is_idle, "it spins")
            resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (most, most))
            self.eventually(lambda: self.answers(server), "the server does not recover")

    def test_a_connection_that_says_nothing_is_closed(self):
        with served() as server, flood(server, 3) as sockets:
            self.eventually(lambda: not any(map(is_open, sockets)), "silent connections stay")

    def test_floods_of_pings_end_the_connection_ordinary_ones_do_not(self):
        with served() as server:
            def pinged(milliseconds):
                return server.channel(**{"grpc.keepalive_time_ms": milliseconds, "grpc.http2.max_pings_without_data": 0,
                                         "grpc.http2.min_time_between_pings_ms": 10})
            with pinged(6_000) as calm, pinged(100) as hasty:
                streams = [endless(channel) for channel in (calm, hasty)]
                # Nobody reads, so that only pings go over the connections.
                time.sleep(13)
                self.eventually(lambda: established(server) == 1, "no connection is ended")
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
        with served("--max-connection-age-seconds", 1) as server, server.channel() as channel:
            stream = endless(channel)
            self.assertEqual(established(server), 1)

            def calls_go_elsewhere():
                self.assertEqual(call(channel, INFO)[0], StatusCode.OK)
                return established(server) > 1
            # The old connection still carries its stream.
            self.eventually(calls_go_elsewhere, "the old connection takes calls for ever")
            next(stream)
            stream.cancel()

    def test_a_drain_takes_no_connection_and_lets_streams_end(self):
        with served() as server, server.channel() as channel:
            stream = endless(channel)
            server.terminate()

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
    main()
