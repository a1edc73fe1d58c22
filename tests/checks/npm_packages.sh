#!/usr/bin/env bash
# Installs the packages that a package.json pins: npm_packages.sh BUILD_DIR
# [PACKAGE_JSON], which prints the folder that holds their node_modules. Without
# one, those of the checks, in package.json beside this script.
#
# They are kept under BUILD_DIR. Exit code 77 (skipped) only when there is no npm
# or its registry cannot be reached.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
list="${2:-${here}/package.json}"
folder="$1/npm"
[[ $# -lt 2 ]] || folder="$1/npm-$(basename "$(dirname "${list}")")"
mkdir -p "${folder}"
build="$(cd "${folder}" && pwd)"

skip() {
  echo "SKIPPED, NOTHING WAS CHECKED: $1" >&2
  exit 77
}

# Two checks may come at the same time.
exec 9>"${build}/lock"
flock 9
if ! cmp --silent "${list}" "${build}/installed.json"; then
  command -v npm >/dev/null || skip "there is no npm on this machine."
  cp "${list}" "${build}/package.json"
  if ! npm install --prefix "${build}" --no-audit --no-fund --no-package-lock --omit=peer \
    --fetch-retries 1 --fetch-timeout 60000 >"${build}/npm.log" 2>&1; then
    cat "${build}/npm.log" >&2
    if grep -qE "ENOTFOUND|EAI_AGAIN|ECONN|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|network" "${build}/npm.log"; then
      skip "npm cannot reach its registry."
    fi
    exit 1
  fi
  cp "${list}" "${build}/installed.json"
fi
echo "${build}"
