#!/usr/bin/python3
"""Requests that are wrong, huge or not requests at all: see fault.py for what must hold after it.

Usage: requests_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import math
import random
import zlib

import grpc

from fault import FaultTest
from http2 import Http2Client
from real_server import FAR_DEADLINE_SECONDS, main, tiles_request
from terrane.v1 import common_pb2, flower_pb2, flower_pb2_grpc, render_pb2, render_pb2_grpc, surface_pb2
from terrane.v1 import surface_pb2_grpc, terrain_pb2, terrain_recipe_pb2, tree_pb2, tree_pb2_grpc

INT64_MAX, INT32_MAX = 2**63 - 1, 2**31 - 1
STREAM_TILES = "/terrane.v1.TerrainService/StreamTiles"
DEADLINE_EXCEEDED, RESOURCE_EXHAUSTED, UNIMPLEMENTED = "4", "8", "12"
# What memory may move by while nothing is allocated for a request.
NOTHING_BYTES = 24 << 20


def violated_fields(error):
    """The fields of the BadRequest in an error's details."""
    details = dict(error.trailing_metadata())["grpc-status-details-bin"]
    status = common_pb2.ErrorStatus.FromString(details)
    (bad_request,) = [d for d in status.details if d.type_url.endswith("google.rpc.BadRequest")]
    return {violation.field for violation in common_pb2.BadRequest.FromString(bad_request.value).field_violations}


class BadNumbers(FaultTest):
    def refused(self, method, request):
        """The fields that the refusal of a call, of a stream or not, names."""
        with self.assertRaises(grpc.RpcError) as raised:
            list(method(request, timeout=FAR_DEADLINE_SECONDS))
        self.assertEqual(raised.exception.code(), grpc.StatusCode.INVALID_ARGUMENT, raised.exception.details())
        return violated_fields(raised.exception)

    def refuse_tiles(self, request):
        return self.refused(self.server.terrain(self.channel()).StreamTiles, request)

    def test_every_field_of_a_recipe_that_is_no_number(self):
        for value in (math.nan, math.inf, -math.inf):
            with self.subTest(value=value):
                request = tiles_request(window=(0, 0, 8, 8))
                recipe = request.terrain.recipe
                recipe.roughness = recipe.fidelity = recipe.sigma = recipe.delta = recipe.soft_limit = value
                recipe.frame.origin_x = recipe.frame.spacing_y = value
                recipe.macro.base = value
                recipe.macro.parts.add().cone.radius = value
                recipe.spots.points.add(x=value, y=0, height=value)
                self.assertLessEqual({
                    "terrain.recipe.roughness", "terrain.recipe.fidelity", "terrain.recipe.sigma",
                    "terrain.recipe.delta", "terrain.recipe.soft_limit", "terrain.recipe.frame.origin_x",
                    "terrain.recipe.frame.spacing_y", "terrain.recipe.macro.base",
                    "terrain.recipe.macro.parts[0].cone.radius", "terrain.recipe.spots.points[0].x",
                    "terrain.recipe.spots.points[0].height"}, self.refuse_tiles(request))

    def test_every_field_out_of_range_at_once(self):
        request = tiles_request(level=99, window=(2**60, 0, 1, 0), tile_size=-5)
        request.sampling, request.encoding = 77, 78
        recipe = request.terrain.recipe
        recipe.dimensions, recipe.source, recipe.mapping, recipe.discrete_method = 3, 99, 98, 97
        recipe.roughness, recipe.fidelity, recipe.domain.cells_x = 1.5, -1, -7
        recipe.continuous_constraints.add(quantity=55, norm=56, edge=57)
        named = self.refuse_tiles(request)
        self.assertLessEqual({
            "level", "window.x", "window.height", "tile_size", "sampling", "encoding",
            "terrain.recipe.dimensions", "terrain.recipe.source", "terrain.recipe.mapping",
            "terrain.recipe.discrete_method", "terrain.recipe.roughness", "terrain.recipe.fidelity",
            "terrain.recipe.domain.cells_x", "terrain.recipe.continuous_constraints[0].quantity",
            "terrain.recipe.continuous_constraints[0].norm", "terrain.recipe.continuous_constraints[0].edge"}, named)

    def test_products_that_overflow(self):
        for request, field in [
                (tiles_request(level=40, window=(0, 0, 2**52, 2**52)), "window"),
                (tiles_request(level=40, window=(2**51, 2**51, INT64_MAX, INT64_MAX)), "window.width"),
                (tiles_request(level=40, window=(-INT64_MAX - 1, 0, 1, 1)), "window.x"),
                (tiles_request(level=40, tiles=(0, 0, 2**40, 2**40)), "tiles"),
                (tiles_request(level=40, tiles=(INT64_MAX, -INT64_MAX, INT64_MAX, 1)), "tiles.x"),
        ]:
            with self.subTest(request=str(request)):
                named = self.refuse_tiles(request)
                self.assertTrue(any(name.startswith(field) for name in named), named)
        domain = tiles_request(level=40)
        domain.terrain.recipe.domain.cells_x = domain.terrain.recipe.domain.cells_y = INT64_MAX
        self.assertIn("terrain.recipe.domain.cells_x", self.refuse_tiles(domain))
        self.assert_memory_flat(NOTHING_BYTES)

    def test_too_many_of_everything(self):
        stub = self.server.terrain(self.channel())
        crowd = tiles_request(window=(0, 0, 8, 8))
        point = terrain_recipe_pb2.DiscreteConstraint()
        crowd.terrain.recipe.discrete_constraints.extend([point] * 200_000)
        crowd.terrain.recipe.macro.parts.extend([terrain_recipe_pb2.MacroPart()] * 5_000)
        self.assertEqual({"terrain.recipe.discrete_constraints", "terrain.recipe.macro.parts"}, {
            name for name in self.refuse_tiles(crowd) if "[" not in name})
        heights = terrain_pb2.GetHeightsRequest(level=3, terrain=tiles_request().terrain)
        heights.points.extend([terrain_recipe_pb2.Point(x=1)] * 150_000)
        self.assertEqual({"points"}, self.refused(stub.GetHeights, heights))
        profile = terrain_pb2.GetProfileRequest(level=40, count=INT64_MAX)
        profile.terrain.recipe.dimensions = 1
        self.assertEqual({"count"}, self.refused(stub.GetProfile, profile))
        # The messages themselves, parsed, take some ten times their 2 MB.
        self.assert_memory_flat(2 * NOTHING_BYTES)

    def test_the_other_generators_refuse_the_same(self):
        channel = self.channel()
        surface = surface_pb2.StreamSurfaceRequest(columns=INT64_MAX, rows=-1, output=44, tile_size=INT32_MAX)
        surface.surface.preset = "surface/fig02"
        self.assertLessEqual({"columns", "rows", "output", "tile_size"}, self.refused(
            surface_pb2_grpc.SurfaceServiceStub(channel).StreamSurface, surface))
        tree = tree_pb2.StreamTreeRequest(from_row=-3)
        tree.tree.recipe.dimensions, tree.tree.recipe.depth, tree.tree.recipe.max_segments = 9, INT32_MAX, INT64_MAX
        self.assertLessEqual({"tree.recipe.dimensions", "tree.recipe.depth", "tree.recipe.max_segments"}, self.refused(
            tree_pb2_grpc.TreeServiceStub(channel).StreamTree, tree))
        flower = flower_pb2.StreamFlowerRequest()
        flower.flower.preset, flower.flower.plants = "flower/rose", INT32_MAX
        self.assertEqual({"flower.preset.bed.plants"}, self.refused(
            flower_pb2_grpc.FlowerServiceStub(channel).StreamFlower, flower))
        picture = render_pb2.StreamRenderRequest(width=INT32_MAX, height=INT32_MAX, passes=-1)
        picture.surface.surface.preset, picture.surface.columns, picture.surface.rows = "surface/fig07", 33, 33
        named = self.refused(render_pb2_grpc.RenderServiceStub(channel).StreamRender, picture)
        self.assertIn("passes", named)
        self.assertTrue({"width", "height"} & named, named)
        self.assert_memory_flat(NOTHING_BYTES)

    def test_bytes_that_are_no_message(self):
        noise = random.Random(7)
        good = tiles_request(window=(0, 0, 8, 8)).SerializeToString()
        call = self.channel().unary_stream(STREAM_TILES)
        refused = 0
        for _ in range(200):
            data = bytearray(good if noise.random() < 0.5 else noise.randbytes(noise.randrange(1, 400)))
            for _ in range(3):
                data[noise.randrange(len(data))] = noise.randrange(256)
            try:
                next(call(bytes(data), timeout=FAR_DEADLINE_SECONDS))
            except grpc.RpcError as error:
                refused += 1
                # The last where the noise asks for more than could be done in time.
                self.assertIn(error.code(), {grpc.StatusCode.INVALID_ARGUMENT, grpc.StatusCode.INTERNAL,
                                             grpc.StatusCode.NOT_FOUND, grpc.StatusCode.RESOURCE_EXHAUSTED})
        self.assertGreater(refused, 100)


class Deadlines(FaultTest):
    def status_within(self, timeout, side):
        client = Http2Client(self.server)
        self.addCleanup(client.close)
        request = tiles_request(level=30, window=(0, 0, side, side))
        try:
            _, trailers = client.call(STREAM_TILES, request.SerializeToString(), [("grpc-timeout", timeout)])
        except ConnectionAbortedError:  # in the midst of a message
            return DEADLINE_EXCEEDED
        return trailers["grpc-status"]

    def test_the_longest_that_can_be_said_is_none(self):
        for timeout in ("2562047H", "2562048H", "99999999H"):  # nanoseconds end between the first two
            with self.subTest(timeout=timeout):
                self.assertEqual(self.status_within(timeout, 8), "0")

    def test_the_shortest_that_can_be_said_is_missed(self):
        for timeout in ("0n", "1n", "00000001u"):
            with self.subTest(timeout=timeout):
                self.assertIn(self.status_within(timeout, 3000), (DEADLINE_EXCEEDED, RESOURCE_EXHAUSTED))


class LargeRequests(FaultTest):
    def test_a_large_message_is_refused(self):
        request = tiles_request()
        request.terrain.recipe.frame.crs = "x" * (6 << 20)
        with self.assertRaises(grpc.RpcError) as raised:
            list(self.server.terrain(self.channel()).StreamTiles(request, timeout=FAR_DEADLINE_SECONDS))
        self.assertEqual(raised.exception.code(), grpc.StatusCode.RESOURCE_EXHAUSTED)

    def test_a_length_that_never_comes_costs_nothing(self):
        for _ in range(20):
            client = Http2Client(self.server)
            self.addCleanup(client.close)
            stream = client.open_stream(STREAM_TILES)
            client.send_data(stream, b"\x00\xff\xff\xff\xff" + bytes(1000))
        self.assert_golden()
        self.assert_memory_flat(NOTHING_BYTES)

    def test_large_metadata_is_refused(self):
        request = tiles_request(window=(0, 0, 8, 8))
        stub = self.server.terrain(self.channel(**{"grpc.max_metadata_size": 1 << 20}))
        for size in (10_000, 100_000, 600_000):
            with self.assertRaises(grpc.RpcError) as raised:
                list(stub.StreamTiles(request, timeout=FAR_DEADLINE_SECONDS, metadata=[("x-large", "m" * size)]))
            # A block that is far too long costs the connection.
            self.assertIn(raised.exception.code(), {grpc.StatusCode.RESOURCE_EXHAUSTED, grpc.StatusCode.UNAVAILABLE})

    def test_a_compression_bomb_is_not_inflated(self):
        compressor = zlib.compressobj(9, wbits=31)
        zeros = bytes(1 << 20)
        bomb = b"".join(compressor.compress(zeros) for _ in range(200)) + compressor.flush()
        self.assertTrue(150_000 < len(bomb) < 250_000, len(bomb))
        for _ in range(3):
            client = Http2Client(self.server)
            _, trailers = client.call(STREAM_TILES, bomb, [("grpc-encoding", "gzip")], compressed=True)
            client.close()
            self.assertEqual(trailers["grpc-status"], UNIMPLEMENTED)
            self.assert_memory_flat(NOTHING_BYTES)

    def test_a_message_of_an_unannounced_compression_is_refused(self):
        client = Http2Client(self.server)
        self.addCleanup(client.close)
        _, trailers = client.call(STREAM_TILES, zlib.compress(bytes(1000)), compressed=True)
        self.assertNotEqual(trailers["grpc-status"], "0")


if __name__ == "__main__":
    main()
