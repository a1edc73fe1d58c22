#!/usr/bin/python3
"""Little memory, by a control group or by a flag: work is refused before there is none left.

Usage: memory_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import os
import pathlib
import threading

import grpc
import numpy

from fault import TimedTest
from real_server import FAR_DEADLINE_SECONDS, PATIENCE_SECONDS, SERVING, is_sanitized, main, tiles_request, wait_until
from terrane.v1 import raster_pb2, raster_pb2_grpc

LIMIT_BYTES = 192 << 20
CGROUPS = pathlib.Path("/sys/fs/cgroup")


def make_group(name):
    """A control group of that much memory, of version 1 or 2; OSError where one may not."""
    version_1 = (CGROUPS / "memory").is_dir()
    group = (CGROUPS / "memory" if version_1 else CGROUPS) / name
    group.mkdir()
    try:
        (group / ("memory.limit_in_bytes" if version_1 else "memory.max")).write_text(str(LIMIT_BYTES))
    except OSError:
        group.rmdir()
        raise
    return group


class Flooded(TimedTest):
    """Uploads of 16 MiB and streams of 4 MiB tiles, sixty at a time."""

    def upload(self, number):
        """16 MiB to be kept."""
        posts = numpy.full(2048 * 2048, number, "<f4").tobytes()
        parts = [raster_pb2.UploadRasterRequest(header=raster_pb2.RasterHeader(width=2048, height=2048))]
        parts += [raster_pb2.UploadRasterRequest(chunk=posts[i:i + (1 << 20)]) for i in range(0, len(posts), 1 << 20)]
        with self.server.channel() as channel:
            raster_pb2_grpc.RasterServiceStub(channel).UploadRaster(iter(parts), timeout=FAR_DEADLINE_SECONDS)

    def stream(self, number):
        """Large tiles, some of them; the rest is cancelled. None is read before one of the streams was
        refused: however slowly their clients come, they are too many at a time."""
        request = tiles_request(seed=number, level=14, window=(0, 0, 1 << 15, 1 << 15), tile_size=1000)
        with self.server.channel() as channel:
            stream = self.server.terrain(channel).StreamTiles(request)
            stream.add_done_callback(lambda _: self.a_stream_is_over.set())
            self.a_stream_is_over.wait(PATIENCE_SECONDS)
            for _ in range(6):
                next(stream)
            stream.cancel()

    def takes_streams(self, channel):
        try:
            self.server.golden_hash(channel)
        except grpc.RpcError as error:
            self.assertEqual(error.code(), grpc.StatusCode.RESOURCE_EXHAUSTED)
            return False
        return True

    def assert_survives_a_flood(self, before_the_end=lambda: None):
        done, refused = [], []
        self.a_stream_is_over = threading.Event()

        def ask(action, number):
            try:
                action(number)
                done.append(number)
            except grpc.RpcError as error:
                refused.append(error.code())

        threads = [threading.Thread(target=ask, args=((self.upload, self.stream)[number % 2], number))
                   for number in range(60)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(self.server.alive(), "the kernel ended the server")
        self.assertTrue(done)
        self.assertEqual(set(refused), {grpc.StatusCode.RESOURCE_EXHAUSTED})
        with self.server.channel() as channel:
            self.assertEqual(self.server.health(channel), SERVING)
            self.assertTrue(wait_until(lambda: self.takes_streams(channel)), "memory stays tight")
            self.assertEqual(*self.server.golden_hash(channel))
        before_the_end()
        self.assertEqual(self.server.end(), 0)


class LittleMemory(Flooded):
    # What is kept is bounded to a third of the limit; streams make tiles of 4 MiB.
    FLAGS = ("--raster-store-mib", "32", "--prepared-mib", "32", "--max-streams", "4", "--workers", "2")

    def setUp(self):
        super().setUp()
        if is_sanitized():
            self.skipTest("AddressSanitizer alone takes more than the limit")
        try:
            self.group = make_group(f"terrane-fault-{os.getpid()}")
        except OSError as error:
            self.skipTest(f"no control group of one's own: {error}")
        self.addCleanup(self.group.rmdir)
        enter = f'echo $$ >"{self.group}/cgroup.procs" && exec "$@"'
        self.server = self.start_server(*self.FLAGS, wrapper=("sh", "-c", enter, "sh"))

    def test_the_server_refuses_before_it_is_killed(self):
        self.assert_survives_a_flood()


class MemoryLimitFlag(Flooded):
    def setUp(self):
        super().setUp()
        if is_sanitized():
            self.skipTest("AddressSanitizer alone takes more than the limit")
        # The stores take their quarters of the limit by themselves.
        self.server = self.start_server("--memory-limit-mib", str(LIMIT_BYTES >> 20), "--max-streams", "4", "--workers", "2")

    def most_bytes(self):
        status = pathlib.Path(f"/proc/{self.server.process.pid}/status").read_text(encoding="ascii")
        return int(status.split("VmHWM:")[1].split()[0]) * 1024

    def test_the_process_stays_below_it(self):
        self.assert_survives_a_flood(lambda: self.assertLess(self.most_bytes(), LIMIT_BYTES))


if __name__ == "__main__":
    main()
