#include "client/bench/sweep.h"

#include <algorithm>
#include <cmath>

namespace terrane::client {
namespace {

// What a server is said to serve without queueing.
constexpr double kServedShare = 0.95;

bool IsServed(const BenchRun* run) {
  return run->good() >= kServedShare * run->offered();
}

}  // namespace

std::vector<const BenchRun*> RungsOf(const BenchReport& report) {
  std::vector<const BenchRun*> rungs;
  for (const BenchRun& run : report.runs()) {
    if (run.loop() == "open" && !run.interrupted()) rungs.push_back(&run);
  }
  std::stable_sort(rungs.begin(), rungs.end(),
                   [](const BenchRun* left, const BenchRun* right) {
                     return left->rate() < right->rate();
                   });
  return rungs;
}

std::optional<double> RateToTry(const BenchReport& report) {
  const std::vector<const BenchRun*> rungs = RungsOf(report);
  const auto beyond = std::find_if_not(rungs.begin(), rungs.end(), IsServed);
  if (beyond == rungs.begin() || beyond == rungs.end()) return std::nullopt;
  return std::sqrt((*std::prev(beyond))->rate() * (*beyond)->rate());
}

BenchSweep SummarizeSweep(const BenchReport& report) {
  BenchSweep sweep;
  for (const BenchRun& run : report.runs()) {
    if (run.loop() == "closed") sweep.set_capacity(run.goodput_per_second());
  }
  const std::vector<const BenchRun*> rungs = RungsOf(report);
  const auto beyond = std::find_if_not(rungs.begin(), rungs.end(), IsServed);
  if (beyond != rungs.begin()) {
    sweep.set_knee((*std::prev(beyond))->offered_per_second());
  }
  if (beyond != rungs.end()) {
    sweep.set_beyond_knee((*beyond)->offered_per_second());
  }
  for (const BenchRun* run : rungs) {
    sweep.set_peak_goodput(
        std::max(sweep.peak_goodput(), run->goodput_per_second()));
    sweep.set_last_goodput(run->goodput_per_second());
  }
  return sweep;
}

}  // namespace terrane::client
