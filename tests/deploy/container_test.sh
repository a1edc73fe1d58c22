#!/usr/bin/env bash
# Builds the image of deploy/container without a daemon and runs it as a cluster would:
# container_test.sh BUILD_DIR TERRANE. Nobody's user, a root that cannot be written, no
# capability, 512 MiB; the client outside asks it over the loopback address; SIGTERM ends
# it with 0; terrane inside works, too. Exit code 77 (skipped) without TERRANE_HEAVY=1.
set -euo pipefail

# shellcheck source=tests/deploy/container_tools.sh
source "$(dirname "${BASH_SOURCE[0]}")/container_tools.sh"
containers_setup "$1"
build_image server "${server_image}"
build_image tools "${tools_image}"
docker-compose --file "${root}/deploy/compose.yaml" --profile bench config --quiet

for image in "${server_image}" "${tools_image}"; do
  [[ "$(podman image inspect "${image}" --format '{{.User}}')" == 65532:65532 ]] || fail "${image} runs as somebody."
done
# Debian is 115 MiB, what the server loads 75, itself 7; a compiler, headers or GDAL left in
# the image would be hundreds more.
size="$(podman image inspect "${server_image}" --format '{{.Size}}')"
((size < 256 << 20)) || fail "the server's image has ${size} bytes."

# Below the ports that Linux hands out by itself.
readonly ports=(29951 29952)
container="$(podman run --detach --network host --read-only --cap-drop=all --security-opt no-new-privileges \
  --memory 512m --pids-limit 256 "${server_image}" --listen "127.0.0.1:${ports[0]}" --http-listen "127.0.0.1:${ports[1]}" \
  --workers 2 --log-format json)"
trap 'podman rm --force "${container}" >/dev/null' EXIT
wait_ready "http://127.0.0.1:${ports[1]}/readyz"

confined "${container}"
memory_limited "http://127.0.0.1:${ports[1]}" 512
same_heights "127.0.0.1:${ports[0]}" "$2"

# What writes GeoTIFF and pictures is there, with all that it loads.
tools=(podman run --rm --network none --read-only --cap-drop=all --tmpfs "/out:rw,mode=1777" "${tools_image}")
"${tools[@]}" terrain --local --preset fbm/fig06b --out /out/a.tif
"${tools[@]}" render --local --preset fbm/fig06b --out /out/a.png

podman stop --time 40 "${container}" >/dev/null
[[ "$(podman inspect "${container}" --format '{{.State.ExitCode}}')" == 0 ]] || fail "the server did not end with 0."
echo "Built, run and stopped."
