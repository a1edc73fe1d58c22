#!/usr/bin/python3
"""Holds the sources to the layers of docs/architecture.md: check_layers.py ROOT.

The first words of an include path are the layer, and arrows only point down.
On Debian every package's header lies in one include folder, so a CMake target
does not stop core/ from including gRPC; this check does. Reads every #include of
the C++ sources under ROOT, prints each broken arrow and exits 1 if there is one.
"""

import dataclasses
import pathlib
import re
import sys

FOUNDATION = ("core/noise/", "core/spline/", "core/grid/", "core/mesh/",
              "core/base/")
LEAVES = ("core/codec/", "core/grid/", "core/mesh/", "core/base/")
RAYTRACE = ("core/raytrace/", "core/mesh/", "core/base/", "core/noise/")

# Headers of others, by what they stand for.
GRPC = (r"grpc(pp)?/", r".*\.grpc\.pb\.h")
PROTOBUF = (r"google/", r".*\.pb\.h")
LOG = (r"spdlog/",)
SOCKETS = (r"sys/socket\.h", r"netinet/", r"arpa/", r"netdb\.h",
           r"boost/(asio|beast)")
FILES = (r"fstream", r"filesystem", r"unistd\.h", r"fcntl\.h", r"sys/stat\.h",
         r"gdal", r"OpenImageIO/")


@dataclasses.dataclass(frozen=True)
class Layer:
  """The files whose path starts with `path`, and what they may include."""
  path: str
  ours: tuple  # prefixes of our own headers that are allowed
  banned: tuple = ()  # patterns of other headers that are not


def generator(name):
  return Layer(f"core/{name}/", (f"core/{name}/",) + FOUNDATION,
               GRPC + PROTOBUF + LOG + SOCKETS + FILES)


# The first layer whose path matches a file is the file's layer.
LAYERS = (
    Layer("core/codec/", LEAVES, GRPC + PROTOBUF + LOG + SOCKETS),
    Layer("core/raytrace/", RAYTRACE, GRPC + PROTOBUF + LOG + SOCKETS + FILES),
    generator("terrain"),
    generator("surface"),
    generator("tree"),
    generator("flower"),
    Layer("core/", FOUNDATION, GRPC + PROTOBUF + LOG + SOCKETS + FILES),
    *(Layer(path, ("server/actor/", "server/convert/", "server/presets/",
                   "core/", "terrane/v1/"), GRPC + SOCKETS)
      for path in ("server/actor/", "server/convert/", "server/presets/")),
    Layer("server/", ("server/", "core/", "terrane/v1/")),
    # The one exception: --local calls the service without a network. The actor's
    # interface hands out the generator's scratch memory.
    Layer("client/local_backend", ("client/", "server/actor/", "terrane/v1/",
                                   "core/terrain/terrain.h") + LEAVES,
          GRPC + SOCKETS),
    Layer("client/", ("client/", "terrane/v1/") + LEAVES),
    Layer("tests/core/", ("core/", "tests/"), GRPC + PROTOBUF + LOG + SOCKETS),
    Layer("tests/", ("core/", "server/", "client/", "terrane/v1/", "tests/")),
)

OUR_LAYERS = ("core/", "server/", "client/", "tests/", "terrane/")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')


def layer_of(path):
  return next((l for l in LAYERS if path.startswith(l.path)), None)


def complaint(path, quote, header):
  """What is wrong with one include, or None."""
  layer = layer_of(path)
  if layer is None:
    return "lies in no layer that tests/checks/check_layers.py knows"
  if header.startswith(OUR_LAYERS):
    if not header.startswith(layer.ours):
      return f"{layer.path}* must not include {header}"
  elif quote == '"' and ("/" not in header or header.startswith(".")):
    return f'"{header}" is not relative to the root of the repository'
  if any(re.match(pattern, header) for pattern in layer.banned):
    return f"{layer.path}* must know nothing of {header}"
  return None


def broken_arrows(root):
  """Every broken arrow under `root` as "file:line: what"."""
  found = []
  for top in ("core", "server", "client", "tests"):
    for file in sorted((root / top).rglob("*")):
      if file.suffix not in (".h", ".cc", ".inc"):
        continue
      path = file.relative_to(root).as_posix()
      for number, line in enumerate(file.read_text().splitlines(), 1):
        include = INCLUDE.match(line)
        what = include and complaint(path, *include.groups())
        if what:
          found.append(f"{path}:{number}: {what}")
  return found


def main():
  root = pathlib.Path(sys.argv[1])
  if not (root / "core").is_dir():
    sys.exit(f"{root} holds no core/")
  found = broken_arrows(root)
  print("\n".join(found) or "Every include points down.")
  sys.exit(1 if found else 0)


if __name__ == "__main__":
  main()
