"""The frame of every test of a fault: a server before it, and what must hold after it.

After each test the server lives, health is SERVING, nothing is in flight, memory and
open files are near what they were, the golden tile has its hash, and SIGTERM ends the
process with 0. Each test is bounded: what hangs ends after two minutes.
"""

import pathlib
import signal
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))

from real_server import RealServer, SERVING, is_sanitized, wait_until  # noqa: E402

# Of which it takes a few, where nobody else wants the processors.
SECONDS_PER_TEST = 120
# What buffers and the allocator may keep of the work that is over: the pool of tile
# buffers alone keeps up to 64 MiB.
MEMORY_MARGIN_BYTES = 96 << 20


class TimedTest(unittest.TestCase):
    """A test that is over after two minutes, one way or the other."""

    def setUp(self):
        def too_long(*_):
            # No TimeoutError: a test may expect that of a socket.
            self.fail(f"the test took more than {SECONDS_PER_TEST} s")

        signal.signal(signal.SIGALRM, too_long)
        signal.alarm(SECONDS_PER_TEST)
        self.addCleanup(signal.alarm, 0)

    def start_server(self, *flags, **options):
        server = RealServer(*flags, **options)
        self.addCleanup(server.kill)
        return server


class FaultTest(TimedTest):
    """One server a test, in `self.server`, with the flags of the class."""

    FLAGS = ()
    # What may be left when all is over.
    memory_margin_bytes = MEMORY_MARGIN_BYTES

    def setUp(self):
        super().setUp()
        # With a call in flight it would not end in time: see assert_well.
        self.server = self.start_server("--drain-seconds", 10 * SECONDS_PER_TEST, *self.FLAGS)
        self.assert_golden()  # what is taken once and kept is taken now
        self.memory_before = self.server.resident_bytes()
        self.files_before = self.server.open_files()
        self.cpu_before = self.server.cpu_seconds()
        # After the cleanups that the test adds: its connections are closed by then.
        self.addCleanup(self.assert_well)

    def channel(self, **options):
        channel = self.server.channel(**options)
        self.addCleanup(channel.close)
        return channel

    def assert_golden(self):
        with self.server.channel() as channel:
            self.assertEqual(*self.server.golden_hash(channel))

    def assert_memory_flat(self, most_bytes):
        """Not more than `most_bytes` above what it was before; AddressSanitizer needs room of its own."""
        growth = self.server.resident_bytes() - self.memory_before
        self.assertLess(growth, most_bytes * (3 if is_sanitized() else 1))

    def calls_in_log(self, count):
        """The lines of the calls, once there are `count` of them besides those of the frame."""
        def lines():
            return self.server.calls()[1:]

        self.assertTrue(wait_until(lambda: len(lines()) >= count), f"{len(lines())} of {count} calls are in the log")
        return lines()

    def assert_well(self):
        server = self.server
        self.assertTrue(server.alive(), server.log_text()[-2000:])
        self.assertTrue(wait_until(server.is_idle), "something is still being computed")
        # First of all: connections that are not closed yet may leave no room for another.
        self.assertTrue(wait_until(lambda: server.open_files() <= self.files_before + 2),
                        f"{server.open_files()} open files, {self.files_before} before")
        with server.channel() as channel:
            self.assertEqual(server.health(channel), SERVING)
            self.assertEqual(*server.golden_hash(channel))
        self.assert_memory_flat(self.memory_margin_bytes)
        self.assertEqual(server.end(), 0)
