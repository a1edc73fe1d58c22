#!/usr/bin/python3
"""Wall clocks that jump by an hour while calls run: see fault.py for what must hold after it.

Usage: clock_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]

libfaketime moves the wall clock that the server reads. Abseil's waits, in which gRPC's
threads sleep, are futexes of the kernel's wall clock, which stays: asleep while the
server's clock is ahead, they oversleep by an hour, as they do when a clock is set back.
So it is put right while calls run: a clock that was ahead is one that is set back then.
"""

import glob
import pathlib
import tempfile
import time

from hyperframe import frame as frames

from fault import FaultTest, wait_until
from http2 import Http2Client
from real_server import FAR_DEADLINE_SECONDS, is_sanitized, main, tiles_request

LIBRARY = glob.glob("/usr/lib/*/faketime/libfaketimeMT.so.1")
HOUR = 3600
LONG_REQUEST = tiles_request(level=30, window=(0, 0, 3000, 3000), tile_size=100)


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
        stream = server.terrain(channel).StreamTiles(LONG_REQUEST, timeout=timeout)
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
        """Of a client that leaves it to the server: one that ends its calls itself may be the first to."""
        deadline = 7
        in_time = [("grpc-timeout", f"{deadline}S")]
        for count, seconds in enumerate((HOUR, -HOUR), start=1):
            with self.subTest(seconds=seconds):
                self.jump(seconds)
                client = Http2Client(self.server)
                self.addCleanup(client.close)
                client.open_stream("/terrane.v1.RasterService/UploadRaster", in_time)  # and nothing comes
                client.start_call("/terrane.v1.TerrainService/StreamTiles", LONG_REQUEST.SerializeToString(), in_time)
                while not isinstance(client.next_frame(), frames.DataFrame):
                    pass  # and nothing more is read
                time.sleep(1)  # gRPC's threads go to sleep, by the clock as it is
                self.jump(0)
                self.assertTrue(wait_until(lambda: len(self.expired()) == 2 * count), self.server.calls())
                for call in self.expired():
                    self.assertGreater(call["total_ms"] / 1000, deadline - 0.1)

    def test_a_drain_is_as_long_as_it_was(self):
        drain = 5
        for seconds in (HOUR, -HOUR):
            with self.subTest(seconds=seconds):
                server = self.start_server("--drain-seconds", str(drain))
                self.jump(seconds)
                client = Http2Client(server)
                self.addCleanup(client.close)
                client.start_call("/terrane.v1.TerrainService/StreamTiles", LONG_REQUEST.SerializeToString())
                while not isinstance(client.next_frame(), frames.DataFrame):
                    pass
                begun = time.monotonic()
                server.terminate()
                time.sleep(1)
                self.jump(0)
                self.assertEqual(server.end(), 0)
                self.assertGreater(time.monotonic() - begun, drain - 0.1)

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
