#!/usr/bin/python3
"""Wall clocks that jump by an hour while calls run: see fault.py for what must hold after it.

Usage: clock_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]

libfaketime moves the server's wall clock alone: deadlines, waits and drains are of the
steady clock. It is put right before the frame looks at the server, for Abseil's waits are
futexes of the wall clock, which libfaketime does not move: while its clock is behind, a
waiting thread of gRPC wakes up again and again, as it would not with a clock that is set.
"""

import collections
import glob
import pathlib
import tempfile
import time

import grpc

from fault import FaultTest, wait_until
from real_server import FAR_DEADLINE_SECONDS, is_sanitized, main, tiles_request

LIBRARY = glob.glob("/usr/lib/*/faketime/libfaketimeMT.so.1")
HOUR = 3600


class ClockJumps(FaultTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(self.jump, 0)

    def start_server(self, *flags, **options):
        if not LIBRARY:
            self.skipTest("there is no libfaketime: install the package faketime")
        if is_sanitized():
            self.skipTest("AddressSanitizer wants to be the first library, and so does libfaketime")
        clock = tempfile.NamedTemporaryFile(prefix="terrane-clock-")
        self.addCleanup(clock.close)
        self.clock = pathlib.Path(clock.name)
        self.jump(0)
        return super().start_server(*flags, **options, env={
            "LD_PRELOAD": LIBRARY[0], "FAKETIME_TIMESTAMP_FILE": clock.name, "FAKETIME_NO_CACHE": "1",
            "FAKETIME_DONT_FAKE_MONOTONIC": "1", "DONT_FAKE_MONOTONIC": "1"})

    def jump(self, seconds):
        self.clock.write_text(f"{seconds:+d}\n")

    def log_time(self):
        """The server's own wall clock, by the log line of a call made now."""
        before = len(self.server.calls())
        self.assert_golden()
        self.assertTrue(wait_until(lambda: len(self.server.calls()) > before))
        return self.server.calls()[-1]["time"]

    def long_stream(self, server, channel, timeout=FAR_DEADLINE_SECONDS):
        """900 tiles, which have begun to come and do not fit into the windows on the way."""
        request = tiles_request(level=30, window=(0, 0, 3000, 3000), tile_size=100)
        stream = server.terrain(channel).StreamTiles(request, timeout=timeout)
        next(stream)
        return stream

    def expired(self):
        """The lines of the calls that passed their deadlines."""
        return [call for call in self.server.calls() if call["code"] == "DEADLINE_EXCEEDED"]

    def test_the_clock_of_the_server_does_jump(self):
        """Without that the other tests would show nothing."""
        before = self.log_time()
        self.jump(48 * HOUR)
        self.assertNotEqual(before[:10], self.log_time()[:10])

    def test_running_calls_outlive_a_jump(self):
        for seconds in (HOUR, -HOUR, 0):
            with self.subTest(seconds=seconds):
                stream = self.long_stream(self.server, self.channel())
                self.jump(seconds)
                self.assertEqual(sum(1 for _ in stream), 900)

    def test_a_deadline_is_as_long_as_it_was(self):
        deadline = 6
        for count, seconds in enumerate((HOUR, -HOUR), start=1):
            with self.subTest(seconds=seconds):
                asked = time.monotonic()
                stream = self.long_stream(self.server, self.channel(), deadline)
                begun = time.monotonic()
                self.jump(seconds)
                time.sleep(deadline + 1)  # too slow a reader
                with self.assertRaises(grpc.RpcError) as raised:
                    collections.deque(stream, maxlen=0)
                self.assertEqual(raised.exception.code(), grpc.StatusCode.DEADLINE_EXCEEDED)
                # Not an hour later than the client does, nor an hour earlier, the server has had enough.
                self.assertTrue(wait_until(lambda: len(self.expired()) == count))
                self.assertGreater(self.expired()[-1]["total_ms"] / 1000, deadline - (begun - asked) - 0.1)

    def test_a_drain_lets_calls_end_whatever_the_clock(self):
        for seconds in (HOUR, -HOUR):
            with self.subTest(seconds=seconds):
                server = self.start_server("--drain-seconds", "100")
                stream = self.long_stream(server, server.channel())
                server.terminate()
                self.jump(seconds)
                self.assertEqual(sum(1 for _ in stream), 900)
                self.assertEqual(server.end(), 0)


if __name__ == "__main__":
    main()
