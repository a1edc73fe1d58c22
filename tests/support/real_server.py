"""A real terrane-server for the tests of faults, of the server's edge and of other clients.

Programs that import this are called NAME TERRANE TERRANE_SERVER STUBS [unittest
arguments] and end with main().
"""

import contextlib
import functools
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import grpc

TERRANE, SERVER, STUBS = sys.argv[1:4]
sys.path.insert(0, STUBS)

from terrane.v1 import common_pb2, terrain_pb2, terrain_pb2_grpc, terrain_recipe_pb2  # noqa: E402

GOLDEN_FILE = pathlib.Path(__file__).resolve().parent.parent / "golden" / "terrain.txt"
HEALTH_CHECK, HEALTH_WATCH = "/grpc.health.v1.Health/Check", "/grpc.health.v1.Health/Watch"
# HealthCheckResponse{status: SERVING} and NOT_SERVING, as bytes.
SERVING, NOT_SERVING = b"\x08\x01", b"\x08\x02"
CLOCK_TICK_SECONDS = 1 / os.sysconf("SC_CLK_TCK")
# What comes at once on a quiet machine may take as long on one that others use.
PATIENCE_SECONDS = 60
# A deadline beyond which a test is over anyway. The server also goes by it: one that looks
# too short for the work is refused, and a machine that stood still makes work look dear.
FAR_DEADLINE_SECONDS = 100
# The exit code of a test that ctest is to show as skipped.
SKIPPED = 77


def tiles_request(*, seed=5, level=9, window=None, tiles=None, tile_size=0):
    """A request of the default recipe; window is (x, y, width, height), tiles the same in tiles."""
    request = terrain_pb2.StreamTilesRequest(level=level, tile_size=tile_size)
    request.terrain.recipe.seed = seed
    if window is not None:
        request.window.CopyFrom(common_pb2.Window(**dict(zip(("x", "y", "width", "height"), window))))
    if tiles is not None:
        request.tiles.CopyFrom(common_pb2.TileRange(**dict(zip(("x", "y", "columns", "rows"), tiles))))
    return request


def endless_request(seed=5):
    """16 GiB of heights in 65,536 tiles: no test sees the end of it."""
    return tiles_request(seed=seed, level=16, window=(0, 0, 65536, 65536))


def golden_tile(name="level_20"):
    """A line of terrain.txt with the default recipe: its request and its hash."""
    line = next(line for line in GOLDEN_FILE.read_text().splitlines() if line.startswith(name + " |"))
    _, _, parameters, digest, *_ = line.split(" | ")
    numbers = re.fullmatch(r"2-D subdivision linear seed (\d+) level (\d+) POINT (\d+)x(\d+) at (-?\d+),(-?\d+)", parameters)
    seed, level, width, height, x, y = map(int, numbers.groups())
    return tiles_request(seed=seed, level=level, window=(x, y, width, height)), digest


def fnv1a(data):
    """The hash of the golden files: FNV-1a, 64 bits."""
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"


def wait_until(condition, seconds=PATIENCE_SECONDS):
    """Whether `condition` came true in time; asked often, so that nobody waits for long."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def is_open(connection):
    """Whether the server has not closed a connection that says nothing."""
    connection.setblocking(False)
    try:
        return connection.recv(1 << 16) != b""
    except BlockingIOError:
        return True
    except ConnectionError:
        return False


@functools.cache
def is_sanitized():
    """Whether the server is built with AddressSanitizer."""
    return "libasan" in subprocess.run(["ldd", SERVER], capture_output=True, text=True, check=True).stdout


class RealServer:
    """One process: started at once, its log kept as JSON. Use as a context, or call kill() or end()."""

    def __init__(self, *flags, listen="127.0.0.1:0", wrapper=(), env=None, preexec_fn=None):
        self._log = tempfile.NamedTemporaryFile(prefix="terrane-server-", suffix=".log")
        # AddressSanitizer holds back what is freed; without that it would look like a leak.
        sanitizer = ":".join(filter(None, [os.environ.get("ASAN_OPTIONS"), "quarantine_size_mb=8"]))
        self.process = subprocess.Popen(
            [*wrapper, SERVER, "--listen", listen, "--log-format", "json", *map(str, flags)],
            stdout=subprocess.PIPE, stderr=self._log, text=True, preexec_fn=preexec_fn,
            env={**os.environ, "ASAN_OPTIONS": sanitizer, **(env or {})})
        line = self.process.stdout.readline()
        assert line.startswith("listening on "), (line, self.log_text())
        host, port = line.split()[-1].split(":")
        self.host, self.port = "127.0.0.1" if host == "0.0.0.0" else host, int(port)
        self.address = f"{self.host}:{self.port}"
        self._draining = False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()

    def kill(self):
        """Ends it without a word, if it still runs."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(PATIENCE_SECONDS)
        self.process.stdout.close()

    def terminate(self):
        self.process.send_signal(signal.SIGTERM)
        self._draining = True

    def end(self):
        """The exit code after SIGTERM, or after what else the test sent."""
        if not self._draining:  # a second signal would cut it short
            self.terminate()
        code = self.process.wait(PATIENCE_SECONDS)
        self.process.stdout.close()
        return code

    def alive(self):
        return self.process.poll() is None

    def channel(self, **options):
        """A connection of its own: channels of the same target would share one."""
        arguments = {"grpc.use_local_subchannel_pool": 1, "grpc.enable_http_proxy": 0, **options}
        return grpc.insecure_channel(self.address, options=[(key, value) for key, value in arguments.items()])

    def terrain(self, channel):
        return terrain_pb2_grpc.TerrainServiceStub(channel)

    def log_text(self):
        return pathlib.Path(self._log.name).read_text()

    def calls(self):
        """The log's line of every call that is over."""
        lines = [json.loads(line) for line in self.log_text().splitlines() if line.endswith("}")]
        return [line for line in lines if line["event"] == "call"]

    def resident_bytes(self):
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
            return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:")) * 1024

    def open_files(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def cpu_seconds(self):
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as stat:
            fields = stat.read().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) * CLOCK_TICK_SECONDS

    def wants_a_processor(self):
        """Whether a thread of it runs now, or would if it had a processor."""
        for stat in pathlib.Path(f"/proc/{self.process.pid}/task").glob("*/stat"):
            with contextlib.suppress(FileNotFoundError, ProcessLookupError):  # the thread has ended
                if stat.read_text(encoding="ascii").rpartition(")")[2].split()[0] == "R":
                    return True
        return False

    def is_idle(self):
        """Whether it works less than a tenth of the next 0.3 seconds and of those after them, and not
        because other processes leave it no more."""
        for _ in range(2):
            before = self.cpu_seconds()
            time.sleep(0.3)
            if self.cpu_seconds() - before > 0.03 or self.wants_a_processor():
                return False
        return True

    def health(self, channel, timeout=PATIENCE_SECONDS):
        return channel.unary_unary(HEALTH_CHECK)(b"", timeout=timeout)

    def golden_hash(self, channel, **options):
        """The hash of the golden tile as it is served now, and the right one."""
        request, digest = golden_tile()
        _, tile = self.terrain(channel).StreamTiles(request, **{"timeout": FAR_DEADLINE_SECONDS, **options})
        return fnv1a(tile.tile.data), digest


@contextlib.contextmanager
def served(*flags, **options):
    """A server for the length of a block; it must end well."""
    server = RealServer(*flags, **options)
    try:
        yield server
    finally:
        code = server.end()
    assert code == 0, server.log_text()


def main():
    """Runs the tests and ends the program. Where some could not run and none failed, it says which
    and why, and ctest shows it as skipped: a green line would hide them."""
    result = unittest.main(argv=sys.argv[:1] + sys.argv[4:], exit=False).result
    for test, reason in result.skipped:
        print(f"skipped: {test}: {reason}")
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if result.skipped else 0)
