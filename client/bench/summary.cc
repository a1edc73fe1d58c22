#include "client/bench/summary.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace terrane::client {
namespace {

using std::chrono::duration;

constexpr double kNsOfMs = 1e6;
// Points of a curve: to each nine of a share as many.
constexpr int kNines = 5;
constexpr int kPointsOfANine = 12;

double Seconds(LoadClock::duration time) {
  return duration<double>(time).count();
}

double Count(std::int64_t number) { return static_cast<double>(number); }

// Shares that draw near to 1 as far as the values reach: 1 - 10^-x in equal
// steps of x.
void AddCurve(const LatencyHistogram& histogram, LatencySummary* summary) {
  const double nines =
      std::min<double>(kNines, std::log10(Count(histogram.count())));
  const auto add = [&](double share) {
    CurvePoint* point = summary->add_curve();
    point->set_share(share);
    point->set_ms(histogram.ValueAt(share) / kNsOfMs);
  };
  for (int i = 0; i <= static_cast<int>(nines * kPointsOfANine); ++i) {
    add(1 - std::pow(10.0, -static_cast<double>(i) / kPointsOfANine));
  }
  add(1);
}

LatencySummary Summarize(const LatencyHistogram& histogram) {
  LatencySummary summary;
  const auto at = [&](double share) {
    return histogram.ValueAt(share) / kNsOfMs;
  };
  summary.set_count(Count(histogram.count()));
  summary.set_mean_ms(histogram.mean_ns() / kNsOfMs);
  summary.set_p50_ms(at(0.5));
  summary.set_p90_ms(at(0.9));
  summary.set_p99_ms(at(0.99));
  summary.set_p999_ms(at(0.999));
  summary.set_p9999_ms(at(0.9999));
  summary.set_max_ms(Count(histogram.largest().count()) / kNsOfMs);
  AddCurve(histogram, &summary);
  return summary;
}

void AddLatencies(const LoadFigures& figures, BenchRun* run) {
  if (figures.latency.count() > 0) {
    *run->mutable_latency() = Summarize(figures.latency);
  }
  if (figures.latency_with_lost.count() > 0) {
    *run->mutable_latency_with_lost() = Summarize(figures.latency_with_lost);
  }
  if (figures.first_data.count() > 0) {
    *run->mutable_first_data() = Summarize(figures.first_data);
  }
  if (figures.refusal.count() > 0) {
    *run->mutable_refusal() = Summarize(figures.refusal);
  }
}

void AddKinds(const LoadFigures& figures, BenchRun* run) {
  for (std::size_t i = 0; i < kRequestKinds; ++i) {
    const ShareFigures& kind = figures.kinds[i];
    if (kind.offered == 0) continue;
    KindSummary* summary = run->add_kinds();
    summary->set_kind(kRequestKindNames[i]);
    summary->set_offered(Count(kind.offered));
    summary->set_good(Count(kind.good));
    summary->set_p50_ms(kind.latency.ValueAt(0.5) / kNsOfMs);
    summary->set_p99_ms(kind.latency.ValueAt(0.99) / kNsOfMs);
  }
}

void AddFairness(const MixOptions& mix, const LoadFigures& figures,
                 BenchRun* run) {
  if (figures.clients.size() < 2) return;
  FairnessSummary fairness;
  std::vector<double> shares;
  for (std::size_t i = 0; i < figures.clients.size(); ++i) {
    const ShareFigures& client = figures.clients[i];
    ClientSummary* summary = fairness.add_clients();
    summary->set_offered(Count(client.offered));
    summary->set_good(Count(client.good));
    const bool is_greedy = mix.greedy_share > 0 && i == 0;
    if (is_greedy || client.offered == 0) continue;
    shares.push_back(Count(client.good) / Count(client.offered));
  }
  if (shares.empty()) return;
  const std::optional<double> jain = JainIndex(shares);
  if (jain.has_value()) fairness.set_jain(*jain);
  fairness.set_least_served(*std::min_element(shares.begin(), shares.end()));
  *run->mutable_fairness() = std::move(fairness);
}

// Whole slices of warm-up and measured time.
void AddTimeLine(const LoadTimes& times, const LoadFigures& figures,
                 BenchRun* run) {
  TimeLine* line = run->mutable_time_line();
  const double seconds = Seconds(figures.slice);
  line->set_seconds(seconds);
  const auto slices =
      std::min(static_cast<std::size_t>((times.warm_up + times.duration) /
                                        figures.slice),
               figures.time_line.size());
  for (std::size_t i = 0; i < slices; ++i) {
    const LoadSlice& slice = figures.time_line[i];
    TimePoint* point = line->add_points();
    for (const auto& [code, count] : slice.codes) {
      CodeCount* codes = point->add_codes();
      codes->set_code(CodeName(code));
      codes->set_count(Count(count) / seconds);
    }
    point->set_not_started(Count(slice.not_started) / seconds);
    point->set_p50_ms(slice.latency.ValueAt(0.5) / kNsOfMs);
    point->set_p99_ms(slice.latency.ValueAt(0.99) / kNsOfMs);
  }
}

void AddCodes(const LoadFigures& figures, BenchRun* run) {
  for (const auto& [code, count] : figures.codes) {
    CodeCount* codes = run->add_codes();
    codes->set_code(CodeName(code));
    codes->set_count(Count(count));
    const auto example = figures.examples.find(code);
    if (example != figures.examples.end()) {
      codes->set_example(example->second);
    }
  }
}

}  // namespace

std::string CodeName(grpc::StatusCode code) {
  // gRPC's codes and Abseil's are the same numbers.
  return absl::StatusCodeToString(static_cast<absl::StatusCode>(code));
}

BenchRun Summarize(const LoadOptions& options, const LoadTimes& times,
                   const MixOptions& mix, const LoadFigures& figures,
                   LoadClock::duration measured) {
  const double seconds = Seconds(measured);
  const auto rate = [&](std::int64_t count) {
    return seconds > 0 ? Count(count) / seconds : 0;
  };
  BenchRun run;
  if (options.rate > 0) {
    run.set_loop("open");
    run.set_rate(options.rate);
  } else {
    run.set_loop("closed");
    run.set_concurrency(options.concurrency);
  }
  run.set_seconds(seconds);
  run.set_deadline_ms(Seconds(times.deadline) * 1e3);
  run.set_offered(Count(figures.offered));
  run.set_not_started(Count(figures.not_started));
  run.set_unfinished(Count(figures.unfinished));
  run.set_good(Count(figures.good));
  run.set_retries(Count(figures.retries));
  run.set_damaged(Count(figures.damaged));
  AddCodes(figures, &run);
  run.set_offered_per_second(rate(figures.offered));
  run.set_completed_per_second(rate(figures.latency.count()));
  run.set_goodput_per_second(rate(figures.good));
  run.set_tiles_per_second(rate(figures.tiles));
  run.set_samples_per_second(rate(figures.samples));
  run.set_bytes_per_second(rate(figures.bytes));
  AddLatencies(figures, &run);
  AddKinds(figures, &run);
  AddFairness(mix, figures, &run);
  AddTimeLine(times, figures, &run);
  return run;
}

UsageSummary Summarize(const UsageWatch& watch) {
  UsageSummary summary;
  summary.set_cpus(watch.cpus().value_or(0));
  summary.set_memory_bytes(watch.memory_bytes().value_or(0));
  summary.set_memory_peak_bytes(watch.memory_peak_bytes());
  return summary;
}

}  // namespace terrane::client
