#!/usr/bin/python3
"""Clients that go away, stall or have no time: see fault.py for what must hold after it.

Usage: clients_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import collections
import random
import threading
import time

import grpc

from fault import FaultTest
from http2 import Http2Client
from real_server import FAR_DEADLINE_SECONDS, PATIENCE_SECONDS, endless_request, main, terrain_pb2, tiles_request, wait_until

STREAM_TILES = "/terrane.v1.TerrainService/StreamTiles"


class ClientsThatGo(FaultTest):
    FLAGS = ("--workers", "2")

    def test_a_client_gone_mid_stream_stops_the_work(self):
        channel = self.server.channel()
        stream = self.server.terrain(channel).StreamTiles(endless_request())
        for _ in range(3):
            next(stream)
        channel.close()
        (call,) = self.calls_in_log(1)
        self.assertEqual(call["code"], "CANCELLED")
        # The client took two tiles; what was made for it beyond those is what fits
        # into the windows and sockets between the two, 64 tiles being 16 MiB.
        self.assertLess(call["tiles"], 2 + 64)

    def test_a_killed_connection_stops_the_work(self):
        client = Http2Client(self.server)
        client.start_call(STREAM_TILES, endless_request().SerializeToString())
        client.receive_at_least(1 << 15)  # tiles are under way
        client.abort()
        (call,) = self.calls_in_log(1)
        self.assertEqual(call["code"], "CANCELLED")

    def test_every_call_of_a_cancel_storm_is_accounted_for(self):
        """started = done + refused + cancelled + bad, each with one line in the log."""
        calls_a_client, clients = 60, 4
        outcomes = collections.Counter()
        lock = threading.Lock()

        def storm(number):
            random_delay = random.Random(number)
            stub = self.server.terrain(self.channel())
            for index in range(calls_a_client):
                kind = ("short", "endless", "bad", "endless")[index % 4]
                request = endless_request() if kind == "endless" else tiles_request(window=(0, 0, 64, 64))
                if kind == "bad":
                    request.level = 999
                stream = stub.StreamTiles(request)
                if kind == "endless":
                    stream.initial_metadata()  # the server has begun
                    time.sleep(random_delay.uniform(0, 0.02))
                    stream.cancel()
                else:
                    try:
                        collections.deque(stream, maxlen=0)
                    except grpc.RpcError:
                        pass
                with lock:
                    outcomes[stream.code().name] += 1

        threads = [threading.Thread(target=storm, args=(number,)) for number in range(clients)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        started = calls_a_client * clients
        logged = self.calls_in_log(started)
        self.assertEqual(len({call["request_id"] for call in logged}), started)
        self.assertEqual(collections.Counter(call["code"] for call in logged), outcomes)
        self.assertEqual(outcomes, {"OK": started // 4, "INVALID_ARGUMENT": started // 4, "CANCELLED": started // 2})


class StalledReaders(FaultTest):
    FLAGS = ("--workers", "2")

    def test_stalled_readers_cost_little_and_hold_nobody_up(self):
        readers = []
        for seed in range(20):
            # Room for everything that is asked for, so that only the socket stalls.
            client = Http2Client(self.server, window=2**31 - 1)
            self.addCleanup(client.close)
            client.start_call(STREAM_TILES, endless_request(seed).SerializeToString())
            readers.append(client)
        # They stall when nothing is made any more.
        self.assertTrue(wait_until(self.server.is_idle), "the server never stalls")
        # Two tiles of 256 KiB are held for each, and what gRPC buffers of one.
        self.assert_memory_flat(20 * (3 << 20))
        for _ in range(10):
            self.assert_golden()
        for client in readers:
            client.abort()
        codes = collections.Counter(call["code"] for call in self.calls_in_log(30))
        self.assertEqual(codes, {"OK": 10, "CANCELLED": 20})


class ReadersThatAreCut(FaultTest):
    FLAGS = ("--stream-idle-seconds", "2")

    def test_one_that_opens_no_window_is_cut(self):
        client = Http2Client(self.server)
        self.addCleanup(client.close)
        client.start_call(STREAM_TILES, endless_request().SerializeToString())
        self.assertEqual(self.calls_in_log(1)[0]["code"], "ABORTED")

    def test_one_whose_socket_is_full_is_cut(self):
        client = Http2Client(self.server, window=2**31 - 1)
        self.addCleanup(client.close)
        client.start_call(STREAM_TILES, endless_request().SerializeToString())
        # CANCELLED where the kernel was faster than a watch that got no processor.
        self.assertIn(self.calls_in_log(1)[0]["code"], ("ABORTED", "CANCELLED"))
        self.assertTrue(client.is_cut())


class ReaderOfAPreparation(FaultTest):
    FLAGS = ("--workers", "1", "--stream-idle-seconds", "2")

    def test_one_that_takes_nothing_is_cut(self):
        # A line of 90,000 spot heights. The last ones in line have progress to tell.
        request = terrain_pb2.PrepareTerrainRequest()
        request.terrain.recipe.spots.level = 16
        line = request.terrain.recipe.spots.lines.add(spacing=1)
        for index in range(600):
            line.vertices.add(x=300 * ((index + 1) // 2 % 2), y=index // 2)
            line.heights.append(index % 7)
        client = Http2Client(self.server, window=0)
        self.addCleanup(client.close)
        for seed in range(6):
            request.terrain.recipe.seed = seed
            client.start_call("/terrane.v1.TerrainService/PrepareTerrain", request.SerializeToString())
        self.assertTrue(wait_until(lambda: "ABORTED" in [call["code"] for call in self.server.calls()]),
                        self.server.calls())


class Deadlines(FaultTest):
    FLAGS = ("--workers", "1")

    def test_an_expired_stream_is_stopped(self):
        # Cheap enough to be admitted; its reader takes nothing, nor ends it.
        client = Http2Client(self.server)
        self.addCleanup(client.close)
        request = tiles_request(level=30, window=(0, 0, 3000, 3000), tile_size=100)
        client.start_call(STREAM_TILES, request.SerializeToString(), [("grpc-timeout", "10S")])
        (call,) = self.calls_in_log(1)
        self.assertEqual(call["code"], "DEADLINE_EXCEEDED")
        self.assertGreater(call["total_ms"], 9900)
        self.assertGreater(call["tiles"], 0)

    def test_what_cannot_end_in_time_is_refused_at_once(self):
        # A quarter of a terabyte, which takes some ten minutes.
        request = tiles_request(level=18, window=(0, 0, 1 << 18, 1 << 18))
        with self.assertRaises(grpc.RpcError) as raised:
            next(self.server.terrain(self.channel()).StreamTiles(request, timeout=PATIENCE_SECONDS))
        self.assertEqual(raised.exception.code(), grpc.StatusCode.RESOURCE_EXHAUSTED)
        self.assertIn("grpc-retry-pushback-ms", dict(raised.exception.trailing_metadata()))
        (call,) = self.calls_in_log(1)
        self.assertEqual((call["code"], call["reason"]), ("RESOURCE_EXHAUSTED", "deadline"))
        self.assertNotIn("tiles", call)

    def test_what_expires_in_the_queue_is_never_computed(self):
        stub = self.server.terrain(self.channel())
        long = terrain_pb2.GetHeightsRequest(level=30)
        long.terrain.recipe.seed = 1
        for index in range(100_000):
            long.points.add(x=index * 7.3, y=index * 1.1)
        short = terrain_pb2.GetHeightsRequest(level=30, terrain=long.terrain, points=long.points[:1])
        # The one worker is busy with these, each some seconds, for longer than the others may wait.
        busy = [stub.GetHeights.future(long, timeout=FAR_DEADLINE_SECONDS) for _ in range(2)]
        self.assertTrue(wait_until(lambda: self.server.cpu_seconds() > self.cpu_before + 0.1))
        late = [stub.GetHeights.future(short, timeout=1.5) for _ in range(10)]
        self.assertIn(grpc.StatusCode.DEADLINE_EXCEEDED, {call.code() for call in late})
        self.assertEqual({call.code() for call in busy}, {grpc.StatusCode.OK})
        self.assertTrue(wait_until(self.server.is_idle))
        # One or the other may have expired before it left the client.
        expired = [call for call in self.calls_in_log(len(busy) + 1) if call["code"] != "OK"]
        self.assertTrue(expired)
        self.assertEqual({call["generate_ms"] for call in expired}, {0})


if __name__ == "__main__":
    main()
