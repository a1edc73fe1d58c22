#!/usr/bin/python3
"""Eight times the load that a server bears: it goes on doing what it can.

Usage: overload_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import json
import pathlib
import subprocess

from fault import FaultTest
from real_server import TERRANE, is_sanitized, main


# More of the processors' time gone to other guests of the host, and no figure means anything.
MOST_STOLEN = 0.05


def processor_times():
    """Ticks of all processors so far: all, and those that the host gave to others."""
    ticks = [int(text) for text in pathlib.Path("/proc/stat").read_text(encoding="ascii").splitlines()[0].split()[1:]]
    return sum(ticks[:8]), ticks[7]


# The contract says 0.8 and 0.95, and docs/operations.md has the table that holds it. Seconds of
# load on a machine shared with the load tester need room: without admission it is 0.05 to 0.15.
LEAST_OF_CAPACITY, LEAST_OF_POLITE = 0.6, 0.9


class Overload(FaultTest):
    FLAGS = ("--workers", "1", "--trust-forwarded-for")
    # Some twenty milliseconds of one worker a request, and half a second to do it in.
    LOAD = ["--tile-size", "512", "--tiles-per-stream", "16", "--deadline", "0.5s", "--warm-up", "2s", "--duration", "4s",
            "--connections", "2", "--progress", "none", "--json", "-"]

    def bench(self, *options):
        done = subprocess.run([TERRANE, "bench", "--server", self.server.address, *self.LOAD, *map(str, options)],
                              check=True, capture_output=True, text=True)
        return json.loads(done.stdout)["runs"]

    def test_goodput_stays_refusals_are_quick_and_the_polite_are_served(self):
        if is_sanitized():
            self.skipTest("under AddressSanitizer a refusal costs about as much as the work")
        all_before, stolen_before = processor_times()
        (closed,) = self.bench("--concurrency", 4)
        capacity = closed["goodput_per_second"]
        (flood,) = self.bench("--rate", 8 * max(capacity, 1), "--clients", 8, "--greedy", 0.95, "--max-in-flight", 20000)
        codes = {entry["code"]: entry["count"] for entry in flood["codes"]}
        # The first client is the greedy one.
        polite = flood["fairness"]["clients"][1:]
        polite_share = sum(client["good"] for client in polite) / sum(client["offered"] for client in polite)
        told = f"capacity {capacity}/s; at 8 times that {flood['goodput_per_second']}/s, {codes}, {flood['fairness']}"
        all_after, stolen_after = processor_times()
        stolen = (stolen_after - stolen_before) / (all_after - all_before)
        if stolen > MOST_STOLEN:
            self.skipTest(f"the host took {100 * stolen:.0f} % of the processors away meanwhile: nothing was checked; {told}")
        self.assertGreater(flood["goodput_per_second"], LEAST_OF_CAPACITY * capacity, told)
        self.assertGreater(codes.get("RESOURCE_EXHAUSTED", 0), 0.5 * flood["offered"], told)
        self.assertLess(flood["refusal"]["p50_ms"], 10, told)
        self.assertGreaterEqual(polite_share, LEAST_OF_POLITE, told)


if __name__ == "__main__":
    main()
