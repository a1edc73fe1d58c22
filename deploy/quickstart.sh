#!/usr/bin/env bash
# Builds Terrane, starts its server on this machine and refines a real elevation
# model over the network, from 3 arc seconds (about 90 m) to about 10 m.
#
#   deploy/quickstart.sh           writes out/quickstart/ and stops the server
#   deploy/quickstart.sh --serve   leaves the server running until Ctrl-C, and
#                                  says how to ask it
#
# Says what it is going to install, with apt-get as root or through sudo. Can be
# run again: only what is missing is installed and built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly dem=tests/data/jacksboro-3arcsec-4326.tif
readonly level=3
readonly out=out/quickstart
readonly server=build/release/bin/terrane-server
readonly terrane=build/release/bin/terrane

serve=false
case "${1:-}" in
  "") ;;
  --serve) serve=true ;;
  *)
    sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
    [[ "$1" == --help ]] && exit 0
    exit 2
    ;;
esac

step() { printf '\n==> %s\n' "$1"; }

server_pid=
stop_server() {
  if [[ -n "${server_pid}" ]]; then
    kill -TERM "${server_pid}" 2>/dev/null || true
    wait "${server_pid}" || true
    server_pid=
  fi
}
trap stop_server EXIT

# Starts the server on a free port and sets `address` to where it listens.
start_server() {
  local log=out/quickstart-server.log waited
  : >"${log}"  # an earlier run's log would name that run's port
  "${server}" --listen 127.0.0.1:0 >"${log}" 2>&1 &
  server_pid=$!
  for ((waited = 0; waited < 200; ++waited)); do
    address="$(sed -n 's/^listening on //p' "${log}")"
    if [[ -n "${address}" ]]; then return; fi
    kill -0 "${server_pid}" 2>/dev/null || break
    sleep 0.1
  done
  echo "The server did not start:" >&2
  cat "${log}" >&2
  exit 1
}

step "Packages"
deploy/install-packages.sh

step "Building the server and the client into build/release"
cmake --preset release --log-level=WARNING
cmake --build --preset release --target terrane-server terrane

step "Starting the server"
rm -rf "${out}"
mkdir -p "${out}"
start_server
echo "terrane-server is listening on ${address}"

step "Refining ${dem} by 2^${level} over the network"
refine=("${terrane}" terrain --server "${address}" --dem "${dem}" --level "${level}")
echo "A GeoTIFF, in the model's own coordinate reference system:"
"${refine[@]}" --out "${out}/jacksboro-10m.tif"
echo "Tiles for a game engine, 16-bit and float, that share their edges:"
"${refine[@]}" --tiles all --tile-size 513 --out "${out}/tiles/jacksboro_x{x}_y{y}.r16"
"${refine[@]}" --tiles all --tile-size 513 --out "${out}/tiles/jacksboro_x{x}_y{y}.f32"
echo "Hillshades of the model and of the result, side by side:"
"${terrane}" render --side-by-side "${dem}" "${out}/jacksboro-10m.tif" --out "${out}/hillshade.png"

step "Wrote into ${out} in ${SECONDS} s"
du --human-readable --apparent-size "${out}"/*

if ${serve}; then
  step "The server goes on; Ctrl-C stops it. Ask it from another terminal:"
  cat <<HELP
  ${terrane} info --server ${address}
  ${terrane} terrain --server ${address} --preset fbm/fig06b --out fig06b.png
  ${terrane} terrain --help
HELP
  wait "${server_pid}"
else
  stop_server
  echo "The server has stopped."
fi
