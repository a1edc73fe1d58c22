#!/usr/bin/env bash
# The long form of the soak test, with the release preset's programs: an hour of mixed load
# and ill-behaved clients, after which nothing may have grown. Prints a line a minute.
#
#   tests/soak/run.sh [MINUTES] [OPTIONS OF soak.py]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

build=build/release
minutes="${1:-60}"
shift || true
if [[ ! -x "${build}/bin/terrane-server" ]]; then
  echo "No ${build}/bin/terrane-server: build the release preset first (cmake --build --preset release)." >&2
  exit 1
fi
exec /usr/bin/python3 tests/soak/soak.py "${build}/bin/terrane" "${build}/bin/terrane-server" \
  "${build}/tests/integration/stubs" --minutes "${minutes}" "$@"
