"""An independent client (Debian's python3-grpcio) against the real server.

Usage: python_client_test.py TERRANE_SERVER STUBS [unittest arguments]
"""

import hashlib
import os
import signal
import struct
import subprocess
import sys
import unittest

import grpc
import numpy
from google.protobuf import any_pb2, descriptor_pb2, descriptor_pool, message_factory

SERVER, STUBS = sys.argv[1:3]
sys.path.insert(0, STUBS)

from terrane.v1 import flower_pb2, flower_pb2_grpc  # noqa: E402
from terrane.v1 import common_pb2, info_pb2, info_pb2_grpc, raster_pb2, raster_pb2_grpc  # noqa: E402
from terrane.v1 import render_pb2, render_pb2_grpc  # noqa: E402
from terrane.v1 import spot_table_pb2, spot_table_pb2_grpc  # noqa: E402
from terrane.v1 import surface_pb2, surface_pb2_grpc  # noqa: E402
from terrane.v1 import terrain_pb2, terrain_pb2_grpc, terrain_recipe_pb2  # noqa: E402
from terrane.v1 import tree_pb2, tree_pb2_grpc, tree_recipe_pb2  # noqa: E402

FIELD = descriptor_pb2.FieldDescriptorProto


def google_rpc():
    """google.rpc's messages as published, which no Debian package holds: name -> class."""
    file = descriptor_pb2.FileDescriptorProto(
        name="google_rpc.proto", package="google.rpc", syntax="proto3", dependency=["google/protobuf/any.proto"])

    def add(message, name, number, kind, repeated=False, type_name=None):
        label = FIELD.LABEL_REPEATED if repeated else FIELD.LABEL_OPTIONAL
        message.field.add(name=name, number=number, type=kind, label=label, type_name=type_name)

    status = file.message_type.add(name="Status")
    add(status, "code", 1, FIELD.TYPE_INT32)
    add(status, "message", 2, FIELD.TYPE_STRING)
    add(status, "details", 3, FIELD.TYPE_MESSAGE, True, ".google.protobuf.Any")
    bad_request = file.message_type.add(name="BadRequest")
    violation = bad_request.nested_type.add(name="FieldViolation")
    add(violation, "field", 1, FIELD.TYPE_STRING)
    add(violation, "description", 2, FIELD.TYPE_STRING)
    add(bad_request, "field_violations", 1, FIELD.TYPE_MESSAGE, True, ".google.rpc.BadRequest.FieldViolation")
    error_info = file.message_type.add(name="ErrorInfo")
    add(error_info, "reason", 1, FIELD.TYPE_STRING)
    add(error_info, "domain", 2, FIELD.TYPE_STRING)
    pool = descriptor_pool.DescriptorPool()
    pool.AddSerializedFile(any_pb2.DESCRIPTOR.serialized_pb)
    pool.Add(file)
    factory = message_factory.MessageFactory(pool)
    return {
        name: factory.GetPrototype(pool.FindMessageTypeByName(f"google.rpc.{name}"))
        for name in ["Status", "BadRequest", "ErrorInfo"]
    }


RPC = google_rpc()


def details(error, name):
    """The details of that type of an RpcError, read as google.rpc messages."""
    trailers = dict(error.trailing_metadata())
    status = RPC["Status"].FromString(trailers["grpc-status-details-bin"])
    assert status.code == error.code().value[0] and status.message == error.details()
    wanted = f"type.googleapis.com/google.rpc.{name}"
    return [RPC[name].FromString(d.value) for d in status.details if d.type_url == wanted]


def resident_bytes(process):
    """The resident set of a process."""
    with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
        line = next(line for line in status if line.startswith("VmRSS:"))
    return int(line.split()[1]) * 1024


class PythonClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # What is freed must be free to be taken again: AddressSanitizer holds back
        # 256 MB of it unless told otherwise, and that would look like a leak.
        sanitizer = ":".join(filter(None, [os.environ.get("ASAN_OPTIONS"), "quarantine_size_mb=8"]))
        cls.server = subprocess.Popen([SERVER, "--listen", "127.0.0.1:0", "--log-level", "error"],
                                      stdout=subprocess.PIPE, text=True, env={**os.environ, "ASAN_OPTIONS": sanitizer})
        address = cls.server.stdout.readline().split()[-1]
        cls.channel = grpc.insecure_channel(address)
        cls.terrain = terrain_pb2_grpc.TerrainServiceStub(cls.channel)

    @classmethod
    def tearDownClass(cls):
        cls.channel.close()
        cls.server.send_signal(signal.SIGTERM)
        assert cls.server.wait(60) == 0
        cls.server.stdout.close()

    def request(self, **fields):
        recipe = terrain_recipe_pb2.TerrainRecipe(seed=5)
        return terrain_pb2.StreamTilesRequest(terrain=terrain_pb2.TerrainChoice(recipe=recipe), **fields)

    def test_tiles_share_their_edges(self):
        request = self.request(level=9, tile_size=65, tiles=common_pb2.TileRange(x=-1, y=3, columns=2, rows=1))
        header, left, right = self.terrain.StreamTiles(request, timeout=60)
        self.assertEqual(header.header.window, common_pb2.Window(x=-64, y=192, width=129, height=65))
        heights = [numpy.frombuffer(m.tile.data, "<f4").reshape(65, 65) for m in (left, right)]
        numpy.testing.assert_array_equal(heights[0][:, -1], heights[1][:, 0])
        self.assertEqual(heights[0].min(), left.tile.minimum)
        self.assertEqual(heights[0].max(), left.tile.maximum)

    def test_violations_are_a_google_rpc_bad_request(self):
        request = self.request(level=99, window=common_pb2.Window(width=-1, height=5))
        request.terrain.recipe.roughness = float("nan")
        request.terrain.recipe.fidelity = -1
        with self.assertRaises(grpc.RpcError) as raised:
            list(self.terrain.StreamTiles(request, timeout=60))
        self.assertEqual(raised.exception.code(), grpc.StatusCode.INVALID_ARGUMENT)
        (bad_request,) = details(raised.exception, "BadRequest")
        violations = {v.field: v.description for v in bad_request.field_violations}
        self.assertIn("got -1", violations["terrain.recipe.fidelity"])
        self.assertIn("(0, 1)", violations["terrain.recipe.roughness"])
        self.assertIn("level", violations)
        self.assertIn("window.width", violations)

    def test_a_surface_comes_as_columns_that_numpy_reads(self):
        request = surface_pb2.StreamSurfaceRequest(columns=90, rows=70, tile_size=40, uvs=True)
        request.surface.preset = "surface/fig02"
        stub = surface_pb2_grpc.SurfaceServiceStub(self.channel)
        header, *messages = list(stub.StreamSurface(request))
        self.assertEqual((header.header.tile_columns, header.header.tile_rows, len(messages)), (3, 2, 6))
        normals = numpy.full((70, 90, 3), numpy.nan, "<f4")
        uvs = numpy.full((70, 90, 2), numpy.nan, "<f4")
        for message in messages:
            tile, window = message.mesh_tile, message.mesh_tile.window
            place = (slice(window.y, window.y + window.height), slice(window.x, window.x + window.width))
            normals[place] = numpy.frombuffer(tile.normals, "<f4").reshape(window.height, window.width, 3)
            uvs[place] = numpy.frombuffer(tile.uvs, "<f4").reshape(window.height, window.width, 2)
        numpy.testing.assert_allclose(numpy.linalg.norm(normals, axis=2), 1, atol=1e-6)
        numpy.testing.assert_array_equal(uvs[0, :, 0], (numpy.arange(90) / 89).astype("<f4"))

    def test_unknown_preset_is_a_google_rpc_error_info(self):
        request = terrain_pb2.GetPresetRequest(name="fbm/nothing")
        with self.assertRaises(grpc.RpcError) as raised:
            self.terrain.GetPreset(request, timeout=60)
        self.assertEqual(raised.exception.code(), grpc.StatusCode.NOT_FOUND)
        (info,) = details(raised.exception, "ErrorInfo")
        self.assertEqual((info.reason, info.domain), ("PRESET_NOT_FOUND", "terrane"))

    def test_uploaded_raster_is_refined(self):
        posts = (numpy.arange(20 * 24, dtype="<f4").reshape(20, 24) % 17) * 3
        header = raster_pb2.RasterHeader(width=24, height=20)
        parts = [raster_pb2.UploadRasterRequest(header=header)]
        data = posts.tobytes()
        parts += [raster_pb2.UploadRasterRequest(chunk=data[i:i + 333]) for i in range(0, len(data), 333)]
        uploaded = raster_pb2_grpc.RasterServiceStub(self.channel).UploadRaster(iter(parts), timeout=60)
        recipe = terrain_recipe_pb2.TerrainRecipe(refinement=terrain_recipe_pb2.Refinement())
        recipe.macro.parts.add().raster.raster_id = uploaded.raster_id
        request = terrain_pb2.StreamTilesRequest(terrain=terrain_pb2.TerrainChoice(recipe=recipe), level=2)
        header, tile = self.terrain.StreamTiles(request, timeout=60)
        self.assertEqual(header.header.window, common_pb2.Window(width=93, height=77))
        heights = numpy.frombuffer(tile.tile.data, "<f4").reshape(77, 93)
        numpy.testing.assert_array_equal(heights[::4, ::4], posts)

    def upload_spots(self, *columns):
        """Uploads columns of spots; their id."""
        rows = len(columns[0])
        data = b"".join(numpy.asarray(column, "<f8").tobytes() for column in columns)
        digest = hashlib.sha256(b"terrane.spots.v1\0" + struct.pack("<QB", rows, len(columns) == 4) + data)
        header = spot_table_pb2.SpotTableHeader(rows=rows, has_standard_errors=len(columns) == 4)
        table_id = "sha256:" + digest.hexdigest()
        parts = [spot_table_pb2.UploadSpotTableRequest(header=header, expected_table_id=table_id)]
        parts += [spot_table_pb2.UploadSpotTableRequest(chunk=data[i:i + 777]) for i in range(0, len(data), 777)]
        uploaded = spot_table_pb2_grpc.SpotTableServiceStub(self.channel).UploadSpotTable(iter(parts), timeout=60)
        self.assertEqual(uploaded.table_id, table_id)
        return table_id

    def test_uploaded_spots_are_met(self):
        random = numpy.random.default_rng(5)
        place = random.choice(65 * 65, 300, replace=False)
        rows, columns = place // 65, place % 65
        heights = random.normal(100, 20, 300)
        recipe = terrain_recipe_pb2.TerrainRecipe(seed=5, fidelity=400)
        recipe.frame.spacing_x, recipe.frame.spacing_y = 8, -8
        recipe.domain.cells_x = recipe.domain.cells_y = 8
        recipe.spots.table_id = self.upload_spots(columns, -rows.astype(float), heights)
        recipe.spots.level = 3
        terrain = terrain_pb2.TerrainChoice(recipe=recipe)
        messages = list(self.terrain.PrepareTerrain(terrain_pb2.PrepareTerrainRequest(terrain=terrain), timeout=60))
        prepared = messages[-1].prepared
        self.assertEqual((prepared.spots.spots, prepared.spots.level, prepared.spots.largest_move), (300, 3, 0))
        request = terrain_pb2.StreamTilesRequest(terrain=terrain, level=3, tile_size=65)
        header, tile = self.terrain.StreamTiles(request, timeout=60)
        self.assertEqual(header.header.recipe_hash, prepared.recipe_hash)
        self.assertEqual(header.header.spots, prepared.spots)
        met = numpy.frombuffer(tile.tile.data, "<f4").reshape(65, 65)[rows, columns]
        numpy.testing.assert_array_equal(met, heights.astype("<f4"))
        # What the header resolved is the same terrain.
        terrain.recipe.CopyFrom(header.header.recipe)
        self.assertEqual(next(self.terrain.StreamTiles(request, timeout=60)).header, header.header)

    def test_unknown_spot_table_is_a_google_rpc_error_info(self):
        request = self.request(window=common_pb2.Window(width=4, height=4))
        request.terrain.recipe.spots.table_id = "sha256:gone"
        with self.assertRaises(grpc.RpcError) as raised:
            list(self.terrain.StreamTiles(request, timeout=60))
        self.assertEqual(raised.exception.code(), grpc.StatusCode.NOT_FOUND)
        (info,) = details(raised.exception, "ErrorInfo")
        self.assertEqual((info.reason, info.domain), ("SPOT_TABLE_NOT_FOUND", "terrane"))

    def test_memory_stays_flat_over_a_huge_stream(self):
        # 65,536 x 65,536 samples are 16 GiB. After the first few hundred tiles the
        # server must not grow any more: 400 MB more of tiles may cost it less than
        # a tenth (a release server stays within 1 MB).
        request = self.request(level=16, window=common_pb2.Window(width=65536, height=65536))
        stream = self.terrain.StreamTiles(request)
        settled = None
        for count, message in enumerate(stream):
            self.assertEqual(message.tile.total if count else 65536, 65536)
            if count == 400:
                settled = resident_bytes(self.server)
            if count == 2000:
                break
        grown = resident_bytes(self.server) - settled
        stream.cancel()
        self.assertLess(grown, 32 << 20)

    def large_tree(self):
        recipe = tree_recipe_pb2.TreeRecipe(dimensions=3, seed=3, depth=18, max_segments=1_000_000,
                                            length_mode=tree_recipe_pb2.LENGTH_MODE_RELATIVE)
        return tree_pb2.TreeChoice(recipe=recipe)

    def test_every_prefix_of_a_tree_parses_as_a_tree(self):
        stub = tree_pb2_grpc.TreeServiceStub(self.channel)
        stream = stub.StreamTree(tree_pb2.StreamTreeRequest(tree=self.large_tree()), timeout=60)
        self.assertTrue(next(stream).HasField("header"))
        starts, ends, parents = (numpy.empty((0, 3), "<f4"),) * 2 + (numpy.empty(0, "<u4"),)
        for message in stream:
            rows = message.segments
            self.assertEqual(rows.first_row, len(parents))
            starts = numpy.concatenate([starts, numpy.frombuffer(rows.starts, "<f4").reshape(-1, 3)])
            ends = numpy.concatenate([ends, numpy.frombuffer(rows.ends, "<f4").reshape(-1, 3)])
            parents = numpy.concatenate([parents, numpy.frombuffer(rows.parents, "<u4")])
            attach = numpy.frombuffer(rows.attaches, "<f4")
            new = numpy.arange(max(rows.first_row, 1), len(parents))
            self.assertTrue((parents[new] < new).all())
            # A row begins where its parent's says: what came so far is connected.
            share = attach[new - rows.first_row][:, None]
            on_parent = starts[parents[new]] * (1 - share) + ends[parents[new]] * share
            numpy.testing.assert_allclose(starts[new], on_parent, atol=1e-3)
            if len(parents) > 100_000:
                break
        stream.cancel()
        self.assertEqual(parents[0], 0xFFFFFFFF)

    def test_a_picture_gets_better_with_every_stage(self):
        stub = render_pb2_grpc.RenderServiceStub(self.channel)
        subject = render_pb2.SurfaceSubject(
            surface=surface_pb2.SurfaceChoice(preset="surface/fig07"), columns=65, rows=65)
        request = render_pb2.StreamRenderRequest(
            surface=subject, ground=True, width=60, height=40, passes=64,
            encoding=render_pb2.PIXEL_ENCODING_LINEAR_FLOAT32_LE)
        pictures = {}
        for message in stub.StreamRender(request, timeout=120):
            if message.HasField("band"):
                pixels = numpy.frombuffer(message.band.pixels, "<f4").reshape(40, 60, 3)
                pictures[message.band.passes] = pixels
        self.assertEqual(list(pictures), [1, 2, 4, 8, 16, 32, 64])
        noise = [numpy.sqrt(((pictures[n] - pictures[64]) ** 2).mean()) for n in (1, 4, 16)]
        self.assertGreater(noise[0], 1.5 * noise[1])
        self.assertGreater(noise[1], 1.5 * noise[2])
        self.assertTrue((pictures[64] >= 0).all())

    def test_a_bed_of_flowers_is_prototypes_and_instances(self):
        request = flower_pb2.StreamFlowerRequest(flower=flower_pb2.FlowerChoice(preset="flower/rose", plants=5))
        header, *parts = flower_pb2_grpc.FlowerServiceStub(self.channel).StreamFlower(request, timeout=60)
        self.assertEqual(header.header.parts, len(parts))
        meshes = [part.prototype for part in parts if part.HasField("prototype")]
        self.assertEqual(header.header.prototypes, len({mesh.prototype for mesh in meshes}))
        rows = [part.instances for part in parts if part.HasField("instances")]
        self.assertEqual(header.header.rows, sum(row.rows for row in rows))
        quaternions = numpy.concatenate([numpy.frombuffer(row.rotations, "<f4").reshape(-1, 4) for row in rows])
        numpy.testing.assert_allclose(numpy.linalg.norm(quaternions, axis=1), 1, atol=1e-5)
        plants = numpy.concatenate([numpy.frombuffer(row.plants, "<u4") for row in rows])
        self.assertEqual(sorted(set(plants)), [0, 1, 2, 3, 4])

    def test_memory_stays_flat_over_large_trees(self):
        # A tree of a million rows is 49 MB; the server keeps the branches that wait
        # to grow, which the estimate bounds, and gives their memory back to the next
        # tree: the second to fifth must not cost anything on top.
        stub = tree_pb2_grpc.TreeServiceStub(self.channel)
        estimate = stub.EstimateTree(tree_pb2.EstimateTreeRequest(tree=self.large_tree()), timeout=60)
        before = resident_bytes(self.server)
        peaks = []
        for _ in range(5):
            rows, peak = 0, 0
            for message in stub.StreamTree(tree_pb2.StreamTreeRequest(tree=self.large_tree()), timeout=120):
                rows += message.segments.rows
                peak = max(peak, resident_bytes(self.server))
            self.assertEqual(rows, 1_000_000)
            peaks.append(peak)
        self.assertLess(peaks[0] - before, estimate.memory_bytes_most + (64 << 20))
        self.assertLess(max(peaks[1:]) - peaks[0], 32 << 20)

    def test_server_says_what_it_allows(self):
        info = info_pb2_grpc.InfoServiceStub(self.channel).GetServerInfo(info_pb2.GetServerInfoRequest(), timeout=60)
        self.assertGreaterEqual(info.limits.max_level, 30)
        self.assertIn("fbm/fig06b", [preset.name for preset in info.presets])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
