#include "client/bench/bench_run.h"

#include <unistd.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>

#include "client/bench/load_progress.h"
#include "client/bench/load_settings.h"
#include "client/bench/summary.h"
#include "client/bench/sweep.h"
#include "client/bench/text_report.h"
#include "client/patience.h"

namespace terrane::client {
namespace {

// Of the readings of CPU time and memory.
constexpr std::chrono::milliseconds kLookInterval{100};
// Rates that a sweep tries between its own: with each, what is not known of the
// knee halves (on a logarithmic scale).
constexpr int kSearchSteps = 2;

LoadClock::duration ClockTime(std::chrono::duration<double> time) {
  return std::chrono::duration_cast<LoadClock::duration>(time);
}

// Watches the measured time only.
void LookAt(const LoadTimes& times, UsageWatch* watch) {
  const LoadClock::time_point now = LoadClock::now();
  if (now < times.measured_from() || now > times.measured_to()) return;
  watch->Look(now);
}

// Reads until it is told that the load is done. A thread of its own, for a
// server's metrics may take their time to come.
void WatchUsage(const LoadTimes& times, const std::vector<UsageWatch*>& watches,
                std::stop_token done) {
  do {
    for (UsageWatch* watch : watches) LookAt(times, watch);
  } while (SleepFor(kLookInterval, done));
}

class Bench {
 public:
  Bench(const BenchOptions& options, CallMaker* calls, OnRun on_run,
        std::stop_token stop)
      : options_(options),
        calls_(calls),
        on_run_(std::move(on_run)),
        stop_(std::move(stop)) {}

  // The run is the report's.
  BenchRun* RunOne(const LoadOptions& load);
  void RunSweep();
  BenchReport TakeReport() { return std::move(report_); }

 private:
  // One rate of a sweep. Nothing at 0, and once the test was stopped.
  void RunRung(double rate, bool searched);

  const BenchOptions& options_;
  CallMaker* const calls_;
  const OnRun on_run_;
  const std::stop_token stop_;
  BenchReport report_;
};

BenchRun* Bench::RunOne(const LoadOptions& load) {
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

  LoadEnd end = LoadEnd::kComplete;
  {
    const std::jthread watcher([&](std::stop_token done) {
      WatchUsage(times, watches, std::move(done));
    });
    LoadProgress progress(options_.progress, LoopText(load));
    end = RunLoad(
        load, RequestMix(mix), calls_, &meter,
        [&](int in_flight) { progress.Show(in_flight, &meter); }, stop_);
  }
  const LoadClock::duration measured = std::clamp<LoadClock::duration>(
      LoadClock::now() - times.measured_from(), {}, times.duration);
  BenchRun* run = report_.add_runs();
  *run = Summarize(load, times, mix, meter.figures(), measured);
  run->set_connections(ConnectionsOf(options_));
  run->set_interrupted(end == LoadEnd::kStopped);
  if (client.has_begun()) *run->mutable_client() = Summarize(client);
  if (server.has_begun()) *run->mutable_server() = Summarize(server);
  if (run->interrupted()) report_.set_interrupted(true);
  on_run_(*run);
  return run;
}

void Bench::RunSweep() {
  std::vector<double> rates = options_.sweep_rates;
  if (!options_.sweep.empty()) {
    LoadOptions closed = options_.load;
    closed.rate = 0;
    const double capacity = RunOne(closed)->goodput_per_second();
    for (const double factor : options_.sweep) {
      rates.push_back(factor * capacity);
    }
  }
  std::sort(rates.begin(), rates.end());
  for (const double rate : rates) RunRung(rate, false);
  for (int i = 0; i < kSearchSteps && !options_.sweep.empty(); ++i) {
    RunRung(RateToTry(report_).value_or(0), true);
  }
  *report_.mutable_sweep() = SummarizeSweep(report_);
}

void Bench::RunRung(double rate, bool searched) {
  if (report_.interrupted() || rate <= 0) return;
  LoadOptions load = options_.load;
  load.rate = rate;
  RunOne(load)->set_searched(searched);
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
      MakeGrpcCalls(options.server, options.security, ConnectionsOf(options),
                    options.mix.clients, &*workload);
  if (!calls.ok()) return calls.status();
  Bench bench(options, calls->get(), on_run, stop);
  if (options.sweep.empty() && options.sweep_rates.empty()) {
    bench.RunOne(options.load);
  } else {
    bench.RunSweep();
  }
  BenchReport report = bench.TakeReport();
  for (const auto& [name, value] : SettingsOf(options)) {
    (*report.mutable_settings())[name] = value;
  }
  return report;
}

}  // namespace terrane::client
