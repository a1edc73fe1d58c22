#!/usr/bin/env bash
# Terrane's trees beside ez-tree's, in one run on one core:
#
#   tests/bench/compare_ez_tree.sh [BUILD_DIR]
#
# BUILD_DIR defaults to build/release; it holds terrane_tree_bench. ez-tree 1.1.0
# is installed there with npm. Both grow wood and mesh it, without leaves; prints
# sections (segments) and vertices a second of CPU time, and the ratio. Exit code
# 77 when there is no npm, or no registry that it can reach.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

build="${1:-build/release}"
bench="${build}/tests/bench/terrane_tree_bench"
if [[ ! -x "${bench}" ]]; then
  echo "No ${bench}: build it first (cmake --build --preset release)." >&2
  exit 1
fi
peer="$(tests/checks/npm_packages.sh "${build}" tests/bench/ez_tree/package.json)"
cp tests/bench/ez_tree/bench.mjs "${peer}"

ours="$(mktemp)"
theirs="$(mktemp)"
trap 'rm -f "${ours}" "${theirs}"' EXIT
# In turns, so that what else runs on the machine slows both.
for _ in 1 2 3; do
  taskset --cpu-list 0 node "${peer}/bench.mjs" 1 | tail -n 1 >>"${theirs}"
  taskset --cpu-list 0 "${bench}" --benchmark_filter='^grown_and_meshed/|^segments/relative_3d$' \
    --benchmark_min_time=1 --benchmark_format=json | tr -d '\n' >>"${ours}"
  echo >>"${ours}"
done
/usr/bin/python3 - "${ours}" "${theirs}" <<'PYTHON'
import json
import statistics
import sys

ours, theirs = ([json.loads(line) for line in open(path)] for path in sys.argv[1:])


def median(values):
    return statistics.median(values)


def counter(name, field):
    return median(bench[field] for run in ours for bench in run["benchmarks"] if bench["name"].startswith(name))


peer_sections = median(run["sections"] / run["seconds"] for run in theirs)
peer_vertices = median(run["vertices"] / run["seconds"] for run in theirs)
rows = [
    ("sections grown and meshed", counter("grown_and_meshed/", "items_per_second"), peer_sections),
    ("vertices of them", counter("grown_and_meshed/", "vertices_per_second"), peer_vertices),
    ("sections grown, without a mesh", counter("segments/", "items_per_second"), peer_sections),
]
print(f"{'a second of CPU time':<32} {'Terrane':>12} {'ez-tree 1.1.0':>14} {'ratio':>7}")
for what, own, peer in rows:
    print(f"{what:<32} {own:12,.0f} {peer:14,.0f} {own / peer:7.1f}")
PYTHON
