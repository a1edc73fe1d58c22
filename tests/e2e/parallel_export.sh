#!/usr/bin/env bash
# An export under GNU parallel: parallel_export.sh TERRANE. Exit code 77 (skipped)
# where there is none.
set -euo pipefail

# shellcheck source=tests/e2e/shards.sh
source "$(dirname "${BASH_SOURCE[0]}")/shards.sh"
[[ -z "$(missing_commands parallel)" ]] || skip "there is no GNU parallel: install the package parallel."

folder="$(mktemp -d)"
trap 'rm -rf "${folder}"' EXIT
parallel --jobs 2 "$1" export "${choice[@]}" --out "${folder}/parts/tile.tif" --shards 4 --shard {} ::: 0 1 2 3
check_parts "$1" "${folder}"
echo "GNU parallel ran 4 shards, which wrote the 20 tiles that one process writes."
