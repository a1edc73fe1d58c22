// Two reports of `terrane bench` side by side. Pure functions, but for
// ReadReport, which reads a file.
#ifndef TERRANE_CLIENT_BENCH_COMPARISON_H_
#define TERRANE_CLIENT_BENCH_COMPARISON_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/bench_report.pb.h"

namespace terrane::client {

// Errors: NOT_FOUND without the file, INVALID_ARGUMENT when it is no report.
absl::StatusOr<BenchReport> ReadReport(const std::string& path);

struct ComparedFigure {
  std::string name;
  double before = 0;
  double after = 0;
  // It got worse by more than the tolerance; only goodput and p99 are judged.
  bool is_worse = false;
};

// Goodput, data and latency of two runs. `tolerance` is a share, such as 0.1.
std::vector<ComparedFigure> Compare(const BenchRun& before,
                                    const BenchRun& after, double tolerance);

struct ReportComparison {
  std::string text;  // a table for each pair of runs
  bool is_worse = false;
};

// Runs are paired in their order. INVALID_ARGUMENT when the reports are not of
// the same runs: another number of them, loop, callers, or deadline.
absl::StatusOr<ReportComparison> CompareReports(const BenchReport& before,
                                                const BenchReport& after,
                                                double tolerance);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_COMPARISON_H_
