#include "client/bench/bench_run.h"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "client/bench/load_progress.h"
#include "client/bench/summary.h"
#include "client/bench/text_report.h"

namespace terrane::client {
namespace {

// Of the readings of CPU time and memory.
constexpr std::chrono::milliseconds kLookInterval{100};

LoadClock::duration ClockTime(std::chrono::duration<double> time) {
  return std::chrono::duration_cast<LoadClock::duration>(time);
}

// Watches the measured time only.
void LookAt(const LoadTimes& times, UsageWatch* watch) {
  const LoadClock::time_point now = LoadClock::now();
  if (now < times.measured_from() || now > times.measured_to()) return;
  if (watch->has_begun()) {
    watch->Look();
  } else {
    watch->Begin();
  }
}

// Reads until it is told that the load is done. A thread of its own, for a
// server's metrics may take their time to come.
void WatchUsage(const LoadTimes& times, const std::vector<UsageWatch*>& watches,
                std::stop_token done) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!done.stop_requested()) {
    for (UsageWatch* watch : watches) LookAt(times, watch);
    never.wait_for(lock, done, kLookInterval, [] { return false; });
  }
}

class Bench {
 public:
  Bench(const BenchOptions& options, CallMaker* calls, OnRun on_run,
        std::stop_token stop)
      : options_(options),
        calls_(calls),
        on_run_(std::move(on_run)),
        stop_(std::move(stop)) {}

  void RunOne(const LoadOptions& load);
  void RunSweep();
  BenchReport TakeReport() { return std::move(report_); }

 private:
  const BenchOptions& options_;
  CallMaker* const calls_;
  const OnRun on_run_;
  const std::stop_token stop_;
  BenchReport report_;
};

void Bench::RunOne(const LoadOptions& load) {
  MixOptions mix = options_.mix;
  // What is cold in one run would be known in the next.
  mix.seed += static_cast<std::uint64_t>(report_.runs_size());
  const LoadTimes times{LoadClock::now(), ClockTime(options_.warm_up),
                        ClockTime(options_.duration),
                        ClockTime(options_.deadline)};
  LoadMeter meter(times, mix.clients);
  UsageWatch client([] { return UsageOfProcess(getpid()); });
  UsageWatch server(options_.server_usage);
  std::vector<UsageWatch*> watches = {&client};
  if (options_.server_usage) watches.push_back(&server);
  BenchRun description;
  description.set_loop(load.rate > 0 ? "open" : "closed");
  description.set_rate(load.rate);
  description.set_concurrency(load.concurrency);

  LoadEnd end = LoadEnd::kComplete;
  {
    const std::jthread watcher([&](std::stop_token done) {
      WatchUsage(times, watches, std::move(done));
    });
    LoadProgress progress(options_.progress, LoopText(description));
    end = RunLoad(
        load, RequestMix(mix), calls_, &meter,
        [&](int in_flight) { progress.Show(in_flight, &meter); }, stop_);
  }
  const LoadClock::duration measured = std::clamp<LoadClock::duration>(
      LoadClock::now() - times.measured_from(), {}, times.duration);
  BenchRun* run = report_.add_runs();
  *run = Summarize(load, times, mix, meter.figures(), measured);
  if (client.has_begun()) *run->mutable_client() = Summarize(client);
  if (server.has_begun()) *run->mutable_server() = Summarize(server);
  if (end == LoadEnd::kStopped) report_.set_interrupted(true);
  on_run_(*run);
}

void Bench::RunSweep() {
  std::vector<double> rates = options_.sweep_rates;
  double capacity = 0;
  LoadOptions load = options_.load;
  if (!options_.sweep.empty()) {
    load.rate = 0;
    RunOne(load);
    capacity = report_.runs(0).goodput_per_second();
    for (const double factor : options_.sweep) {
      rates.push_back(factor * capacity);
    }
  }
  std::sort(rates.begin(), rates.end());
  std::vector<BenchRun> runs;
  for (const double rate : rates) {
    if (report_.interrupted() || rate <= 0) break;
    load.rate = rate;
    RunOne(load);
    runs.push_back(report_.runs(report_.runs_size() - 1));
  }
  *report_.mutable_sweep() = SummarizeSweep(capacity, runs);
}

}  // namespace

absl::StatusOr<BenchReport> RunBench(const BenchOptions& options,
                                     Backend* backend, const OnRun& on_run,
                                     std::stop_token stop) {
  const absl::StatusOr<Workload> workload =
      Workload::Create(options.workload, options.mix.weights, backend, stop);
  if (!workload.ok()) return workload.status();
  if (options.server_usage) {
    const absl::StatusOr<Usage> usage = options.server_usage();
    if (!usage.ok()) return usage.status();
  }
  const absl::StatusOr<std::unique_ptr<CallMaker>> calls =
      MakeGrpcCalls(options.server, options.security, options.connections,
                    options.mix.clients, &*workload);
  if (!calls.ok()) return calls.status();
  Bench bench(options, calls->get(), on_run, stop);
  if (options.sweep.empty() && options.sweep_rates.empty()) {
    bench.RunOne(options.load);
  } else {
    bench.RunSweep();
  }
  return bench.TakeReport();
}

}  // namespace terrane::client
