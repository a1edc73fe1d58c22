#!/usr/bin/env bash
# Lints proto/ with buf: check_proto.sh BUILD_DIR. Exit code 77 (skipped) as
# npm_packages.sh; 1 when the lint finds something.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
packages="$("${here}/npm_packages.sh" "$1")"
cd "${here}/../../proto"
"${packages}/node_modules/.bin/buf" lint
echo "buf lint: $(find . -name '*.proto' | wc -l) files of proto/ are clean."
