// Two reports of `terrane bench` side by side. Pure functions, but for
// ReadReport, which reads a file.
#ifndef TERRANE_CLIENT_BENCH_COMPARISON_H_
#define TERRANE_CLIENT_BENCH_COMPARISON_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/bench/load_settings.h"
#include "client/bench_report.pb.h"

namespace terrane::client {

// Errors: NOT_FOUND without the file, INVALID_ARGUMENT when it is no report.
absl::StatusOr<BenchReport> ReadReport(const std::string& path);

// Whether a test with these settings can be compared with the report at all.
// INVALID_ARGUMENT names every setting that differs with both values; so for a
// report that was interrupted or that does not say its settings.
absl::Status CheckSameLoad(const BenchReport& before,
                           const LoadSettings& settings);

struct ComparedFigure {
  std::string name;
  double before = 0;
  double after = 0;
  // It got worse by more than the tolerance; only goodput and p99 are judged,
  // with and without what was lost.
  bool is_worse = false;
};

// Goodput, data and latency of two runs. `tolerance` is a share, such as 0.1.
std::vector<ComparedFigure> Compare(const BenchRun& before,
                                    const BenchRun& after, double tolerance);

struct ReportComparison {
  std::string text;  // a table for each pair of runs
  bool is_worse = false;
};

// Of two reports of the same load. Runs are paired in their order, without
// those that a sweep tried between its rates, which are not the same ones.
ReportComparison CompareReports(const BenchReport& before,
                                const BenchReport& after, double tolerance);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_COMPARISON_H_
