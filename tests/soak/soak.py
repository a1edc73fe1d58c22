#!/usr/bin/python3
"""A server under mixed load and ill-behaved clients for a long time: does anything grow?

Usage: soak.py TERRANE TERRANE_SERVER STUBS [--minutes M] [--json FILE]

Memory, descriptors and threads are looked at every second. The first quarter of the time
fills caches and buffers; after that the medians of the second and of the last quarter must
be alike. At the end the server must be idle, serve the golden tile and end with 0.
`tests/soak/run.sh` runs an hour of it, ctest (`-L soak`) two minutes.
"""

import argparse
import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import grpc
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "fault"))

from http2 import Http2Client  # noqa: E402
from real_server import SERVING, TERRANE, RealServer, endless_request, tiles_request, wait_until  # noqa: E402
from terrane.v1 import raster_pb2, raster_pb2_grpc  # noqa: E402

# Small stores, full after seconds; connections that age, so that many come and go.
FLAGS = ("--raster-store-mib", "16", "--prepared-mib", "4", "--max-connection-age-seconds", "10", "--log-level", "warning")
MIX = "tiles=6,profiles=2,surfaces=1,trees=1,flowers=1"
# What the last quarter may lie above the second one.
MOST_MIB, MOST_FILES, MOST_THREADS = 16, 8, 2
STREAM_TILES = "/terrane.v1.TerrainService/StreamTiles"


class Sampler(threading.Thread):
    """Memory in MiB, open files and threads of a process, every second."""

    def __init__(self, server):
        super().__init__()
        self._server, self._ended = server, threading.Event()
        self.samples = []

    def run(self):
        while not self._ended.wait(1):
            status = pathlib.Path(f"/proc/{self._server.process.pid}/status").read_text(encoding="ascii")
            self.samples.append({"mib": self._server.resident_bytes() / (1 << 20), "files": self._server.open_files(),
                                 "threads": int(status.split("Threads:")[1].split()[0])})

    def stop(self):
        self._ended.set()
        self.join()

    def quarter(self, number, what):
        """The median over one quarter of the time, 0 to 3."""
        count = len(self.samples)
        return statistics.median(sample[what] for sample in self.samples[number * count // 4:(number + 1) * count // 4])


class Nuisances(threading.Thread):
    """What clients do that mean no harm, and some that do, one after another."""

    def __init__(self, server, seed):
        super().__init__()
        self._server, self._random, self._ended = server, random.Random(seed), threading.Event()
        self.done = 0
        self.error = None

    def run(self):
        deeds = [self.leaves_early, self.goes_without_a_word, self.reads_nothing, self.asks_nonsense, self.has_no_time,
                 self.uploads]
        try:
            while not self._ended.wait(0.05):
                self._random.choice(deeds)()
                self.done += 1
        except Exception as error:  # pylint: disable=broad-except # told at the end
            self.error = error

    def stop(self):
        self._ended.set()
        self.join()

    def leaves_early(self):
        with self._server.channel() as channel:
            stream = self._server.terrain(channel).StreamTiles(endless_request())  # with a deadline it would be refused
            next(stream)
            stream.cancel()

    def goes_without_a_word(self):
        client = Http2Client(self._server)
        client.start_call(STREAM_TILES, endless_request().SerializeToString())
        client.receive_at_least(1000)
        client.abort()

    def reads_nothing(self):
        client = Http2Client(self._server, window=8 << 20)
        client.start_call(STREAM_TILES, endless_request().SerializeToString())
        time.sleep(0.5)
        client.close()

    def asks_nonsense(self):
        with self._server.channel() as channel:
            self._fails(grpc.StatusCode.INVALID_ARGUMENT, lambda: list(self._server.terrain(channel).StreamTiles(
                tiles_request(level=-1), timeout=10)))

    def has_no_time(self):
        with self._server.channel() as channel:
            try:
                list(self._server.terrain(channel).StreamTiles(endless_request(), timeout=0.2))
            except grpc.RpcError:  # refused, or cut at its deadline
                pass

    def uploads(self):
        posts = numpy.full(256 * 256, self._random.random(), "<f4").tobytes()
        header = raster_pb2.RasterHeader(width=256, height=256)
        with self._server.channel() as channel:
            raster_pb2_grpc.RasterServiceStub(channel).UploadRaster(
                iter([raster_pb2.UploadRasterRequest(header=header), raster_pb2.UploadRasterRequest(chunk=posts)]), timeout=10)

    def _fails(self, code, call):
        try:
            call()
        except grpc.RpcError as error:
            if error.code() != code:
                raise
        else:
            raise AssertionError(f"no {code}")


def bench(server, seconds, seed):
    """One run of the load tester: its report."""
    with tempfile.NamedTemporaryFile(suffix=".json") as report:
        subprocess.run([TERRANE, "bench", "--server", server.address, "--concurrency", "6", "--connections", "2", "--mix", MIX,
                        "--cold", "0.3", "--retry", "5", "--deadline", "60s", "--seed", str(seed), "--warm-up", "0s",
                        "--duration", f"{seconds}s", "--json", report.name, "--progress", "none"],
                       check=True, stdout=subprocess.DEVNULL, timeout=seconds + 120)
        return json.loads(pathlib.Path(report.name).read_text(encoding="utf-8"))


def soak(minutes):
    """Its figures; AssertionError for what grew or broke."""
    with RealServer(*FLAGS) as server:
        sampler, nuisances = Sampler(server), Nuisances(server, seed=1)
        threads = [sampler, nuisances]
        for thread in threads:
            thread.start()
        codes = {}
        end = time.monotonic() + 60 * minutes
        try:
            rounds = 0
            while (left := end - time.monotonic()) > 1:
                for run in bench(server, max(1, min(10, round(left))), seed=rounds)["runs"]:
                    for entry in run["codes"]:
                        codes[entry["code"]] = codes.get(entry["code"], 0) + int(entry["count"])
                rounds += 1
                assert nuisances.error is None, f"a nuisance failed: {nuisances.error!r}"
                if rounds % 6 == 1:
                    print(f"{sum(codes.values())} calls, {nuisances.done} nuisances, {sampler.samples[-1]}", flush=True)
        finally:
            for thread in reversed(threads):
                thread.stop()
        assert wait_until(server.is_idle), "something is still being computed"
        with server.channel() as channel:
            assert server.health(channel) == SERVING
            is_served, is_right = server.golden_hash(channel)
            assert is_served == is_right, "the golden tile has changed"
        server.terminate()
        assert server.process.wait(40) == 0, "the server did not end with 0"

    figures = {"codes": codes, "nuisances": nuisances.done, "seconds": len(sampler.samples)}
    for what, most in [("mib", MOST_MIB), ("files", MOST_FILES), ("threads", MOST_THREADS)]:
        second, last = sampler.quarter(1, what), sampler.quarter(3, what)
        figures[what] = {"second_quarter": second, "last_quarter": last, "most": max(s[what] for s in sampler.samples)}
        assert last <= second + most, f"{what} grew from {second} to {last}: {figures}"
    assert set(codes) <= {"OK"}, codes
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs=3, metavar=("TERRANE", "TERRANE_SERVER", "STUBS"))
    parser.add_argument("--minutes", type=float, default=60, help="how long (default: 60)")
    parser.add_argument("--json", type=pathlib.Path, help="write the figures here")
    arguments = parser.parse_args()
    figures = soak(arguments.minutes)
    print(json.dumps(figures, indent=1))
    if arguments.json:
        arguments.json.write_text(json.dumps(figures, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
