#!/usr/bin/python3
"""Servers that end, gently and not, under load.

Usage: restart_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import filecmp
import pathlib
import signal
import subprocess
import tempfile
import threading
import time

import grpc
from hyperframe import frame as frames

from fault import TimedTest
from http2 import Http2Client
from real_server import FAR_DEADLINE_SECONDS, HEALTH_WATCH, NOT_SERVING, PATIENCE_SECONDS, SERVING, TERRANE, main
from real_server import tiles_request, wait_until


class Load:
    """Clients that call again and again until health says NOT_SERVING; every outcome."""

    def __init__(self, server, clients=3):
        self._server = server
        self.serving = True
        self.done = self.refused = 0
        self.failed = []
        self._lock = threading.Lock()
        self._threads = [threading.Thread(target=self._watch)]
        self._threads += [threading.Thread(target=self._call) for _ in range(clients)]
        for thread in self._threads:
            thread.start()

    def _watch(self):
        with self._server.channel() as channel:
            watch = channel.unary_stream(HEALTH_WATCH)(b"")
            try:
                for answer in watch:
                    if answer != SERVING:
                        self.serving = answer != NOT_SERVING
                        break
            except grpc.RpcError as error:  # it has gone without a word
                self.failed.append(error)
                self.serving = False
            watch.cancel()

    def _call(self):
        with self._server.channel() as channel:
            stub = self._server.terrain(channel)
            while self.serving:
                try:
                    request = tiles_request(window=(0, 0, 200, 200), tile_size=50)
                    messages = list(stub.StreamTiles(request, timeout=FAR_DEADLINE_SECONDS))
                    assert len(messages) == 17
                    with self._lock:
                        self.done += 1
                except grpc.RpcError as error:
                    with self._lock:
                        # Refused by a port that is closed: the server never had it.
                        if not self.serving and error.code() == grpc.StatusCode.UNAVAILABLE:
                            self.refused += 1
                        else:
                            self.failed.append(error)

    def join(self):
        for thread in self._threads:
            thread.join()


class GentleEnd(TimedTest):
    def long_streams(self, server, count, tiles_a_side):
        """Streams under way: their messages so far are on their way, the rest is up to the server."""
        streams = []
        for seed in range(count):
            channel = server.channel()
            self.addCleanup(channel.close)
            # Costly tiles in small messages: half a second of one core each stream.
            request = tiles_request(seed=seed, level=30, tiles=(0, 0, tiles_a_side, tiles_a_side), tile_size=65)
            stream = server.terrain(channel).StreamTiles(request)
            next(stream)
            streams.append(stream)
        return streams

    def test_sigterm_under_load_fails_no_call(self):
        # Seconds of grace, in which every client hears of it even when it stands still for a moment.
        server = self.start_server("--workers", "2", "--grace-seconds", "5", "--drain-seconds", "60")
        load = Load(server)
        self.assertTrue(wait_until(lambda: load.done > 5))
        streams = self.long_streams(server, 4, 24)
        server.terminate()
        self.assertTrue(wait_until(lambda: not load.serving), "health never said NOT_SERVING")
        for stream in streams:
            self.assertEqual(sum(message.HasField("tile") for message in stream), 24 * 24)
        load.join()
        self.assertEqual(server.end(), 0)
        self.assertEqual(load.failed, [])
        codes = {call["code"] for call in server.calls()}
        self.assertEqual(codes, {"OK"})

    def test_a_slow_reader_gets_the_end_of_its_stream(self):
        """The connection ends with its last stream: not before the kernel has sent what it holds of it."""
        server = self.start_server("--drain-seconds", "100")
        client = Http2Client(server, window=64 << 20)
        self.addCleanup(client.close)
        heights = 2 << 20
        request = tiles_request(window=(0, 0, 2048, heights // 2048), tile_size=128).SerializeToString()
        client.start_call("/terrane.v1.TerrainService/StreamTiles", request)
        client.receive_at_least(1 << 16)
        server.terminate()
        bytes_read, trailers = 0, {}
        while "grpc-status" not in trailers:
            frame = client.next_frame()
            if isinstance(frame, frames.DataFrame):
                bytes_read += len(frame.data)
                # Had the server's end of the connection gone, this would cut off what is on its way.
                client.answer(frames.WindowUpdateFrame(0, window_increment=len(frame.data)))
                time.sleep(0.002)
            elif isinstance(frame, frames.HeadersFrame):
                trailers = client.headers_of(frame)
        self.assertEqual(trailers["grpc-status"], "0")
        self.assertGreater(bytes_read, 4 * heights)
        self.assertEqual(server.end(), 0)

    def test_a_drain_that_takes_too_long_is_cut(self):
        server = self.start_server("--workers", "1", "--drain-seconds", "1")
        (stream,) = self.long_streams(server, 1, 4_000)
        begin = time.monotonic()
        server.terminate()
        with self.assertRaises(grpc.RpcError):
            for _ in stream:
                pass
        self.assertEqual(server.end(), 0)
        self.assertGreater(time.monotonic() - begin, 1)

    def test_a_second_signal_ends_at_once(self):
        server = self.start_server("--drain-seconds", "600")
        self.long_streams(server, 1, 4_000)
        server.terminate()
        self.assertTrue(wait_until(lambda: "draining" in server.log_text()))
        server.terminate()
        self.assertEqual(server.end(), 1)


# Of killing a server before it is done, for which a machine that stands still may leave no time.
ATTEMPTS = 5


class ClientMidStream(TimedTest):
    CHOICE = ["terrain", "--seed", "11", "--level", "30", "--window", "0,0,4096,4096", "--tile-size", "256"]

    def setUp(self):
        super().setUp()
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def start_client(self, server, out):
        """A client that has its first tile."""
        client = subprocess.Popen([TERRANE, *self.CHOICE, "--server", server.address, "--out", out, "--progress", "json"],
                                  stderr=subprocess.PIPE, text=True)
        self.addCleanup(client.stderr.close)
        self.addCleanup(client.kill)
        client.stderr.readline()  # printed with it
        return client

    def client_of_a_killed_server(self, out):
        """A client whose server was killed when the first tile had come, and the address of that server.
        The client is stopped: it would give up after some seconds, which a new server may need to start."""
        server = self.start_server("--workers", "1")
        client = self.start_client(server, out)
        client.send_signal(signal.SIGSTOP)
        server.kill()
        return client, server.address

    def test_a_client_resumes_with_the_restarted_server(self):
        out, alone = self.folder / "resumed.f32", self.folder / "alone.f32"
        for _ in range(ATTEMPTS):
            client, address = self.client_of_a_killed_server(out)
            second = self.start_server(listen=address)
            client.send_signal(signal.SIGCONT)
            self.assertEqual(client.wait(PATIENCE_SECONDS), 0, client.stderr.read())
            if wait_until(second.calls, 5):
                break
        (call,) = second.calls()
        self.assertLess(call["tiles"], 256)  # only what was missing
        subprocess.run([TERRANE, *self.CHOICE, "--local", "--out", alone], check=True, capture_output=True)
        self.assertTrue(filecmp.cmp(out, alone, shallow=False))

    def test_a_client_that_was_suspended_for_too_long_goes_on(self):
        out, alone = self.folder / "resumed.f32", self.folder / "alone.f32"
        for _ in range(ATTEMPTS):
            server = self.start_server("--stream-idle-seconds", "1")
            client = self.start_client(server, out)
            client.send_signal(signal.SIGSTOP)
            self.assertTrue(wait_until(server.calls), "the reader is still waited for")
            client.send_signal(signal.SIGCONT)
            self.assertEqual(client.wait(PATIENCE_SECONDS), 0, client.stderr.read())
            if server.calls()[0]["code"] != "OK":
                break
        self.assertTrue(wait_until(lambda: server.calls()[-1]["code"] == "OK"), server.calls())
        # Cut once; more often where the machine stood still, too.
        cuts = {call["code"] for call in server.calls()[:-1]}
        self.assertTrue(cuts)
        self.assertLessEqual(cuts, {"ABORTED", "CANCELLED"})
        subprocess.run([TERRANE, *self.CHOICE, "--local", "--out", alone], check=True, capture_output=True)
        self.assertTrue(filecmp.cmp(out, alone, shallow=False))

    def test_a_client_of_a_server_that_stays_away_gives_up_cleanly(self):
        out = self.folder / "never.f32"
        for _ in range(ATTEMPTS):
            client, _ = self.client_of_a_killed_server(out)
            client.send_signal(signal.SIGCONT)
            if client.wait(PATIENCE_SECONDS) != 0:
                break
            out.unlink()
        self.assertEqual(client.returncode, 4)
        self.assertIn("does not answer", client.stderr.read())
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    main()
