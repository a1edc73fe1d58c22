#!/usr/bin/python3
"""Tests of check_layers.py on small trees made for the purpose."""

import pathlib
import tempfile
import unittest

import check_layers


def broken(files):
  """The broken arrows of a tree given as {path: text}."""
  with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    for path, text in files.items():
      (root / path).parent.mkdir(parents=True, exist_ok=True)
      (root / path).write_text(text)
    return check_layers.broken_arrows(root)


class CheckLayersTest(unittest.TestCase):

  def test_arrows_that_point_down_pass(self):
    self.assertEqual([], broken({
        "core/base/a.h": "#include <vector>\n",
        "core/terrain/a.cc": '#include "core/terrain/a.h"\n'
                             '#include "core/noise/hash.h"\n'
                             '#include "hwy/highway.h"\n'
                             '#include "absl/status/status.h"\n',
        "core/codec/png.cc": "#include <OpenImageIO/imageio.h>\n",
        "server/actor/a.cc": '#include "terrane/v1/terrain.pb.h"\n'
                             '#include "core/terrain/terrain.h"\n',
        "server/service/a.cc": "#include <grpcpp/grpcpp.h>\n",
        "client/local_backend.cc": '#include "server/actor/actor.h"\n',
        "client/a.cc": '#include "core/codec/png.h"\n',
    }))

  def test_each_broken_arrow_is_found(self):
    cases = {
        "core/terrain/a.cc": ["<grpcpp/grpcpp.h>", '"terrane/v1/terrain.pb.h"',
                              "<google/protobuf/message.h>", "<fstream>",
                              '"spdlog/spdlog.h"', "<sys/socket.h>",
                              '"core/tree/tree.h"', '"core/codec/png.h"',
                              '"server/actor/actor.h"', '"client/client.h"',
                              '"terrain.h"', '"../base/a.h"'],
        "core/base/a.h": ['"core/terrain/terrain.h"', "<filesystem>"],
        "core/codec/png.h": ['"core/terrain/terrain.h"',
                             '"terrane/v1/common.pb.h"'],
        "server/actor/a.h": ['"server/service/a.h"', "<grpcpp/grpcpp.h>",
                             '"terrane/v1/terrain.grpc.pb.h"'],
        "server/service/a.cc": ['"client/client.h"'],
        "client/a.cc": ['"server/actor/actor.h"', '"core/terrain/terrain.h"'],
        "client/local_backend.cc": ['"server/service/a.h"'],
        "tests/core/a_test.cc": ['"server/actor/actor.h"'],
    }
    for path, headers in cases.items():
      for header in headers:
        with self.subTest(path=path, header=header):
          found = broken({path: f"\n#include {header}\n"})
          self.assertEqual(1, len(found), found)
          self.assertTrue(found[0].startswith(f"{path}:2: "), found[0])


if __name__ == "__main__":
  unittest.main()
