#include "client/bench/text_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "client/bench/sweep.h"
#include "client/progress.h"

namespace terrane::client {
namespace {

constexpr double kMib = 1 << 20;

std::string PercentText(double part, double whole) {
  return fmt::format("{:.1f} %", whole > 0 ? 100 * part / whole : 0);
}

double CountOf(const BenchRun& run, const std::string& code) {
  for (const CodeCount& codes : run.codes()) {
    if (codes.code() == code) return codes.count();
  }
  return 0;
}

std::string LatencyLine(const char* name, const LatencySummary& latency) {
  return fmt::format(
      "{:<12} p50 {}  p90 {}  p99 {}  p99.9 {}  p99.99 {}  max {}\n", name,
      MillisecondsText(latency.p50_ms()), MillisecondsText(latency.p90_ms()),
      MillisecondsText(latency.p99_ms()), MillisecondsText(latency.p999_ms()),
      MillisecondsText(latency.p9999_ms()), MillisecondsText(latency.max_ms()));
}

std::string CodeLines(const BenchRun& run) {
  std::string text;
  for (const CodeCount& codes : run.codes()) {
    text += fmt::format("  {:<20} {:>9.0f}  {:>7}", codes.code(), codes.count(),
                        PercentText(codes.count(), run.offered()));
    if (!codes.example().empty()) {
      text += fmt::format("  {}", codes.example().substr(0, 100));
    }
    text += '\n';
  }
  for (const auto& [name, count] :
       {std::pair("not started", run.not_started()),
        std::pair("unfinished", run.unfinished())}) {
    if (count <= 0) continue;
    text += fmt::format("  {:<20} {:>9.0f}  {:>7}\n", name, count,
                        PercentText(count, run.offered()));
  }
  return text;
}

std::string FairnessLine(const FairnessSummary& fairness) {
  if (!fairness.has_jain()) {
    return fmt::format("fairness     none of {} clients was served\n",
                       fairness.clients_size());
  }
  return fmt::format(
      "fairness     Jain index {:.4f} over {} clients, the least served got "
      "{}\n",
      fairness.jain(), fairness.clients_size(),
      PercentText(fairness.least_served(), 1));
}

std::string UsageLine(const char* name, const UsageSummary& usage) {
  return fmt::format("{:<12} {:.2f} CPUs, {:.0f} MiB, {:.0f} MiB at most\n",
                     name, usage.cpus(), usage.memory_bytes() / kMib,
                     usage.memory_peak_bytes() / kMib);
}

std::string KneeText(const BenchSweep& sweep) {
  if (sweep.knee() <= 0) return "The lowest rate is beyond the knee. ";
  if (sweep.beyond_knee() <= 0) {
    return fmt::format("No knee up to {:.1f}/s offered. ", sweep.knee());
  }
  return fmt::format("Knee at {:.1f}/s offered; {:.1f}/s is too much. ",
                     sweep.knee(), sweep.beyond_knee());
}

}  // namespace

std::string MillisecondsText(double ms) {
  if (ms >= 1000) return fmt::format("{:.2f} s", ms / 1000);
  if (ms >= 100) return fmt::format("{:.0f} ms", ms);
  if (ms >= 1) return fmt::format("{:.2f} ms", ms);
  return fmt::format("{:.0f} us", ms * 1000);
}

std::string LoopText(const LoadOptions& load) {
  return load.rate > 0
             ? fmt::format("open loop, {:.4g} requests/s", load.rate)
             : fmt::format("closed loop, {} callers", load.concurrency);
}

std::string LoopText(const BenchRun& run) {
  return LoopText(LoadOptions{
      .rate = run.rate(), .concurrency = static_cast<int>(run.concurrency())});
}

std::string RunText(const BenchRun& run) {
  std::string text = fmt::format(
      "{}, {:.0f} connections, {:.3g} s measured, deadline {}\n"
      "goodput      {:.1f}/s of {:.1f}/s offered ({}), {:.1f}/s ended well\n"
      "data         {}tiles/s, {}samples/s, {:.1f} MiB/s\n",
      LoopText(run), run.connections(), run.seconds(),
      MillisecondsText(run.deadline_ms()), run.goodput_per_second(),
      run.offered_per_second(), PercentText(run.good(), run.offered()),
      run.completed_per_second(), ShortNumber(run.tiles_per_second()),
      ShortNumber(run.samples_per_second()), run.bytes_per_second() / kMib);
  if (run.has_latency()) text += LatencyLine("latency", run.latency());
  if (run.latency_with_lost().count() > run.latency().count()) {
    text += LatencyLine("with lost", run.latency_with_lost());
  }
  if (run.has_first_data()) text += LatencyLine("first data", run.first_data());
  if (run.has_refusal()) text += LatencyLine("refusals", run.refusal());
  text += fmt::format("requests     {:.0f}", run.offered());
  if (run.retries() > 0) text += fmt::format(", {:.0f} retries", run.retries());
  text += '\n' + CodeLines(run);
  if (run.kinds_size() > 1) {
    for (const KindSummary& kind : run.kinds()) {
      text += fmt::format("{:<12} {:.0f} of {:.0f} good, p50 {}, p99 {}\n",
                          kind.kind(), kind.good(), kind.offered(),
                          MillisecondsText(kind.p50_ms()),
                          MillisecondsText(kind.p99_ms()));
    }
  }
  if (run.has_fairness()) {
    text += FairnessLine(run.fairness());
  }
  if (run.has_server()) text += UsageLine("server", run.server());
  if (run.has_client()) text += UsageLine("this client", run.client());
  return text;
}

std::string SweepMarkdown(const BenchReport& report) {
  const BenchSweep& sweep = report.sweep();
  std::string text =
      "| offered/s | of capacity | goodput/s | good | refused | late or cut | "
      "p50 | p99 | refusal p50 | least served |\n"
      "|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const BenchRun* rung : RungsOf(report)) {
    const BenchRun& run = *rung;
    const double refused = CountOf(run, "RESOURCE_EXHAUSTED");
    const auto ms = [](bool known, double value) {
      return known ? MillisecondsText(value) : std::string("-");
    };
    text += fmt::format(
        "| {:.1f} | {} | {:.1f} | {} | {} | {} | {} | {} | {} | {} |\n",
        run.offered_per_second(),
        sweep.capacity() > 0
            ? fmt::format("{:.2g}", run.rate() / sweep.capacity())
            : "-",
        run.goodput_per_second(), PercentText(run.good(), run.offered()),
        PercentText(refused, run.offered()),
        PercentText(run.offered() - run.good() - refused, run.offered()),
        ms(run.has_latency(), run.latency().p50_ms()),
        ms(run.has_latency(), run.latency().p99_ms()),
        ms(run.has_refusal(), run.refusal().p50_ms()),
        run.has_fairness() ? PercentText(run.fairness().least_served(), 1)
                           : "-");
  }
  text += '\n';
  if (sweep.capacity() > 0) {
    text += fmt::format("Capacity {:.1f}/s (closed loop). ", sweep.capacity());
  }
  text += KneeText(sweep);
  text += fmt::format(
      "Peak goodput {:.1f}/s; at the highest rate {:.1f}/s, {} of it.\n",
      sweep.peak_goodput(), sweep.last_goodput(),
      PercentText(sweep.last_goodput(), sweep.peak_goodput()));
  return text;
}

}  // namespace terrane::client
