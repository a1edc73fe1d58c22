#!/usr/bin/env bash
# Lints proto/ with buf: check_proto.sh BUILD_DIR.
#
# buf comes from npm in the version that package.json pins and is kept under
# BUILD_DIR. Exit code 77 (skipped) only when there is no npm or its registry
# cannot be reached; 1 when the lint finds something.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
mkdir -p "$1/buf"
build="$(cd "$1/buf" && pwd)"

skip() {
  echo "SKIPPED, proto/ WAS NOT LINTED: $1"
  exit 77
}

if ! cmp --silent "${here}/package.json" "${build}/installed.json"; then
  command -v npm >/dev/null || skip "there is no npm on this machine."
  cp "${here}/package.json" "${build}/package.json"
  if ! npm install --prefix "${build}" --no-audit --no-fund --no-package-lock \
    --fetch-retries 1 --fetch-timeout 60000 >"${build}/npm.log" 2>&1; then
    cat "${build}/npm.log"
    if grep -qE "ENOTFOUND|EAI_AGAIN|ECONN|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|network" "${build}/npm.log"; then
      skip "npm cannot reach its registry."
    fi
    exit 1
  fi
  cp "${here}/package.json" "${build}/installed.json"
fi

cd "${here}/../../proto"
"${build}/node_modules/.bin/buf" lint
echo "buf lint: $(find . -name '*.proto' | wc -l) files of proto/ are clean."
