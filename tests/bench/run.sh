#!/usr/bin/env bash
# Runs the core benches and prints a table of medians: nanoseconds a sample, and
# times the hash bound and memset of the same side in the same run.
#
#   tests/bench/run.sh [BENCH] [FILTER]
#
# BENCH defaults to the release preset's program, FILTER (a regular expression)
# to all benches. The whole run's JSON is kept beside the program.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

bench="${1:-build/release/tests/bench/terrane_core_bench}"
filter="${2:-.}"
if [[ ! -x "${bench}" ]]; then
  echo "No ${bench}: build the release preset first (cmake --build --preset release)." >&2
  exit 1
fi
json="${bench}.json"
"${bench}" --benchmark_filter="^bound/|${filter}" --benchmark_min_time=0.05 --benchmark_repetitions=5 \
  --benchmark_enable_random_interleaving=true --benchmark_out_format=json --benchmark_out="${json}" >/dev/null
/usr/bin/python3 tests/bench/ratios.py "${json}"
