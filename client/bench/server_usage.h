// CPU time and memory of the server under test and of the load tester itself.
//
// The server's come from /proc, by its process id on this machine, or from its
// metrics over HTTP (process_cpu_seconds_total, and terrane_memory_bytes or
// process_resident_memory_bytes).
//
// Belongs to one thread. Errors: NOT_FOUND, naming what could not be read.
#ifndef TERRANE_CLIENT_BENCH_SERVER_USAGE_H_
#define TERRANE_CLIENT_BENCH_SERVER_USAGE_H_

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/statusor.h"

namespace terrane::client {

struct Usage {
  // Not set when the source does not say.
  std::optional<double> cpu_seconds;  // since the process began
  std::optional<double> memory_bytes;
};

using UsageSource = std::function<absl::StatusOr<Usage>()>;

absl::StatusOr<Usage> UsageOfProcess(int pid);
absl::StatusOr<Usage> UsageOfMetrics(const std::string& url);
// The same out of Prometheus text; samples of one name are added up.
Usage UsageOfMetricsText(const std::string& text);

// What a source shows from its first reading to its last.
class UsageWatch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit UsageWatch(UsageSource source) : source_(std::move(source)) {}

  // Reads the source. When it cannot be read, what it said last stands.
  void Look(TimePoint now);
  bool has_begun() const { return first_.has_value(); }

  // CPUs that were kept busy from the first reading to the last, in the mean.
  std::optional<double> cpus() const;
  std::optional<double> memory_bytes() const {
    return last_.usage.memory_bytes;
  }
  double memory_peak_bytes() const { return peak_; }

 private:
  struct Reading {
    TimePoint time;
    Usage usage;
  };

  UsageSource source_;
  std::optional<Reading> first_;
  Reading last_;
  double peak_ = 0;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_SERVER_USAGE_H_
