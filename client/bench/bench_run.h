// RunBench: a load test from its options to its report: one load, or a sweep of
// several.
#ifndef TERRANE_CLIENT_BENCH_BENCH_RUN_H_
#define TERRANE_CLIENT_BENCH_BENCH_RUN_H_

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/backend.h"
#include "client/bench/load.h"
#include "client/bench/request_mix.h"
#include "client/bench/server_usage.h"
#include "client/bench/workload.h"
#include "client/bench_report.pb.h"
#include "client/channel_security.h"
#include "client/progress.h"

namespace terrane::client {

struct BenchOptions {
  std::string server;
  ChannelSecurity security;
  std::optional<int> connections;  // default: as ConnectionsOf says
  MixOptions mix;
  WorkloadOptions workload;
  LoadOptions load;
  std::chrono::duration<double> warm_up{2};
  std::chrono::duration<double> duration{10};
  std::chrono::duration<double> deadline{5};
  // A sweep: open loops at these multiples of what a closed loop reaches first,
  // and at two rates more, between which the knee lies; or at these rates and
  // no other. At most one of them.
  std::vector<double> sweep;
  std::vector<double> sweep_rates;
  // Empty when the server's CPU time and memory cannot be read.
  UsageSource server_usage;
  ProgressMode progress = ProgressMode::kAuto;
};

// Shows each run as soon as it is done.
using OnRun = std::function<void(const BenchRun&)>;

// `backend` is the same server's; it is asked for presets before the load. A
// stop ends the load at once; the report then holds what was measured until
// then. Version, time and options of the report are for the caller to fill in.
absl::StatusOr<BenchReport> RunBench(const BenchOptions& options,
                                     Backend* backend, const OnRun& on_run,
                                     std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_BENCH_RUN_H_
