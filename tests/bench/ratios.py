#!/usr/bin/python3
"""Prints the ratios of a run of terrane_core_bench: ratios.py RUN.json."""

import collections
import json
import re
import statistics
import sys


def natural_order(item):
  """Sorts by name, side:64 before side:256."""
  return [int(part) if part.isdigit() else part
          for part in re.split(r"(\d+)", item[0])]


def main():
  with open(sys.argv[1], encoding="utf-8") as file:
    run = json.load(file)
  times = collections.defaultdict(list)
  for bench in run["benchmarks"]:
    if bench.get("run_type") == "iteration" and "ns_per_sample" in bench:
      times[bench["run_name"]].append(bench["ns_per_sample"])
  medians = {name: statistics.median(values) for name, values in times.items()}
  print("SIMD target", run["context"]["simd_target"])
  print(f"{'bench':<66} {'ns/sample':>9} {'x hash':>7} {'x memset':>8}")
  for name, median in sorted(medians.items(), key=natural_order):
    side = re.search(r"side:\d+", name).group()
    print(f"{name:<66} {median:9.3f} {median / medians['bound/hash/' + side]:7.2f}"
          f" {median / medians['bound/memset/' + side]:8.1f}")


if __name__ == "__main__":
  main()
