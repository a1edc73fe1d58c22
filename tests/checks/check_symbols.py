#!/usr/bin/python3
"""Reads the symbols of the core library: check_symbols.py libterrane_core.a.

Fails when its objects hold or ask for symbols of gRPC, Protobuf or spdlog, open
files or sockets, or call a function of libm whose result differs from one
libm to the next (core/base/det_math.h has what the core may use instead).
"""

import re
import subprocess
import sys

# Symbols of these are not wanted, whether defined (header-only code) or not.
TRANSPORT = re.compile(
    r"\b(grpc|grpc_impl|grpc_core|google::protobuf|spdlog|terrane::v1)::"
    r"|^(grpc|gpr)_")

# Undefined symbols that are not wanted.
SYSTEM = re.compile(
    r"^(socket|connect|bind|listen|accept4?|open(64|at)?|fopen(64)?|creat|mmap"
    r"|std::basic_(filebuf|[io]?fstream)<.*|std::filesystem::.*)$")
LIBM = re.compile(
    r"^(a?(sin|cos|tan)h?|atan2|exp2?|exp10|expm1|log(2|10|1p|b)?|pow|cbrt|hypot"
    r"|sincos|erfc?|[lt]gamma)[fl]?$")


def complaints(nm_output):
  """What is wrong, as "object: symbol", in an output of `nm -C`."""
  found = []
  unit = ""
  for line in nm_output.splitlines():
    if line.endswith(":"):
      unit = line[:-1]
      continue
    match = re.match(r"^[0-9a-f ]*([A-Za-z?-]) (.*)$", line)
    if not match:
      continue
    kind, symbol = match.groups()
    name = re.sub(r"@.*", "", symbol)
    if TRANSPORT.search(name):
      found.append(f"{unit}: {name}")
    elif kind in "Uw" and (SYSTEM.match(name.split("(")[0]) or
                           LIBM.match(name)):
      found.append(f"{unit}: {name}")
  return found


def main():
  nm = subprocess.run(["nm", "--demangle", sys.argv[1]], check=True,
                      capture_output=True, text=True)
  if "terrane::core::" not in nm.stdout:
    sys.exit(f"{sys.argv[1]} holds nothing of terrane::core")
  found = complaints(nm.stdout)
  print("\n".join(found) or "The core's objects are free of transport, files, "
        "sockets and libm.")
  sys.exit(1 if found else 0)


if __name__ == "__main__":
  main()
