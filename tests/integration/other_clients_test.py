#!/usr/bin/python3
"""Clients of other makes against the real server: Node.js, `buf curl`, h2load.

Usage: other_clients_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]

TERRANE_BUILD_DIR names the folder that npm's packages are kept in.
"""

import base64
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "support"))

from real_server import SKIPPED, RealServer, fnv1a, golden_tile, main, wait_until  # noqa: E402
from google.protobuf import json_format  # noqa: E402

STREAM_TILES = "/terrane.v1.TerrainService/StreamTiles"
INVALID_ARGUMENT = 3


def npm_packages(*package_json):
    """The folder of npm's packages, installed when they are missing."""
    script = ROOT / "tests" / "checks" / "npm_packages.sh"
    done = subprocess.run([script, os.environ["TERRANE_BUILD_DIR"], *package_json], capture_output=True, text=True)
    if done.returncode == SKIPPED:
        raise unittest.SkipTest(done.stderr.strip())
    assert done.returncode == 0, done.stderr
    return pathlib.Path(done.stdout.strip()) / "node_modules"


class OtherClients(unittest.TestCase):
    def setUp(self):
        self.server = self.enterContext(RealServer("--reflection"))
        self.request, self.digest = golden_tile()
        self.json = json_format.MessageToDict(self.request)

    def run_client(self, *command, **options):
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=300, **options)

    def test_node(self):
        packages = npm_packages(ROOT / "tests" / "integration" / "node" / "package.json")
        bad = {**self.json, "level": 99}
        done = self.run_client("node", ROOT / "tests" / "integration" / "node" / "client.js", self.server.address,
                               ROOT / "proto", input=json.dumps({"request": self.json, "bad": bad}),
                               env={**os.environ, "NODE_PATH": str(packages)})
        self.assertEqual(done.returncode, 0, done.stderr)
        answer = json.loads(done.stdout)
        self.assertEqual((answer["code"], answer["messages"], answer["hash"]), (0, 2, self.digest))
        self.assertEqual(answer["badCode"], INVALID_ARGUMENT)
        self.assertIn("level: must be", answer["badDetails"])

    def buf_curl(self, *options, data):
        return self.run_client(npm_packages() / ".bin" / "buf", "curl", "--protocol", "grpc", "--http2-prior-knowledge",
                               *options, "--data", json.dumps(data), f"http://{self.server.address}{STREAM_TILES}")

    def test_buf_curl_by_schema_and_by_reflection(self):
        for options in (["--schema", ROOT / "proto"], ["--reflect-protocol", "grpc-v1alpha"]):
            with self.subTest(options=options):
                done = self.buf_curl(*options, data=self.json)
                self.assertEqual(done.returncode, 0, done.stderr)
                decoder, text, messages = json.JSONDecoder(), done.stdout.strip(), []
                while text:
                    message, end = decoder.raw_decode(text)
                    messages.append(message)
                    text = text[end:].lstrip()
                self.assertEqual([list(message) for message in messages], [["header"], ["tile"]])
                self.assertEqual(fnv1a(base64.b64decode(messages[1]["tile"]["data"])), self.digest)

    def test_buf_curl_reads_the_error(self):
        done = self.buf_curl("--schema", ROOT / "proto", data={**self.json, "level": 99})
        self.assertNotEqual(done.returncode, 0)
        error = json.loads(done.stderr)
        self.assertEqual(error["code"], "invalid_argument")
        self.assertIn("level: must be", error["message"])

    def test_h2load(self):
        """It sees HTTP, not gRPC: the server's log tells how the calls went."""
        if shutil.which("h2load") is None:
            self.skipTest("there is no h2load: install the package nghttp2-client")
        calls, message = 500, self.request.SerializeToString()
        with tempfile.NamedTemporaryFile() as body:
            body.write(b"\0" + len(message).to_bytes(4, "big") + message)
            body.flush()
            done = self.run_client("h2load", "-n", calls, "-c", 4, "-m", 8, "-d", body.name, "-H",
                                   "content-type: application/grpc", "-H", "te: trailers",
                                   f"http://{self.server.address}{STREAM_TILES}")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"{calls} succeeded, 0 failed, 0 errored, 0 timeout", done.stdout)
        self.assertTrue(wait_until(lambda: len(self.server.calls()) == calls))
        self.assertEqual({(call["code"], call["tiles"]) for call in self.server.calls()}, {("OK", 1)})


if __name__ == "__main__":
    main()
