#!/usr/bin/env bash
# Installs the packages that package.json pins: npm_packages.sh BUILD_DIR, which
# prints the folder that holds their node_modules.
#
# They are kept under BUILD_DIR. Exit code 77 (skipped) only when there is no npm
# or its registry cannot be reached.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
mkdir -p "$1/npm"
build="$(cd "$1/npm" && pwd)"

skip() {
  echo "SKIPPED, NOTHING WAS CHECKED: $1" >&2
  exit 77
}

# Two checks may come at the same time.
exec 9>"${build}/lock"
flock 9
if ! cmp --silent "${here}/package.json" "${build}/installed.json"; then
  command -v npm >/dev/null || skip "there is no npm on this machine."
  cp "${here}/package.json" "${build}/package.json"
  if ! npm install --prefix "${build}" --no-audit --no-fund --no-package-lock \
    --fetch-retries 1 --fetch-timeout 60000 >"${build}/npm.log" 2>&1; then
    cat "${build}/npm.log" >&2
    if grep -qE "ENOTFOUND|EAI_AGAIN|ECONN|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|network" "${build}/npm.log"; then
      skip "npm cannot reach its registry."
    fi
    exit 1
  fi
  cp "${here}/package.json" "${build}/installed.json"
fi
echo "${build}"
