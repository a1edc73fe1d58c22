#include "client/bench/comparison.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <fstream>
#include <iterator>

#include "client/bench/text_report.h"

namespace terrane::client {
namespace {

constexpr double kFormat = 1;

absl::Status CheckSameLoad(const BenchRun& before, const BenchRun& after) {
  if (before.loop() == after.loop() &&
      before.concurrency() == after.concurrency() &&
      before.deadline_ms() == after.deadline_ms()) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(fmt::format(
      "the reports are of different loads: {}, deadline {} against {}, "
      "deadline {}",
      LoopText(before), MillisecondsText(before.deadline_ms()), LoopText(after),
      MillisecondsText(after.deadline_ms())));
}

std::string RatioText(double before, double after) {
  return before > 0 ? fmt::format("{:.3f}", after / before) : "-";
}

}  // namespace

absl::StatusOr<BenchReport> ReadReport(const std::string& path) {
  std::ifstream file(path);
  if (!file) return absl::NotFoundError("cannot read " + path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  BenchReport report;
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;  // of a later version
  const auto parsed =
      google::protobuf::util::JsonStringToMessage(text, &report, options);
  if (!parsed.ok() || report.format() != kFormat || report.runs_size() == 0) {
    return absl::InvalidArgumentError(path +
                                      " is no report of terrane bench --json");
  }
  return report;
}

std::vector<ComparedFigure> Compare(const BenchRun& before,
                                    const BenchRun& after, double tolerance) {
  std::vector<ComparedFigure> figures = {
      {"goodput/s", before.goodput_per_second(), after.goodput_per_second()},
      {"samples/s", before.samples_per_second(), after.samples_per_second()},
      {"bytes/s", before.bytes_per_second(), after.bytes_per_second()},
      {"p50 ms", before.latency().p50_ms(), after.latency().p50_ms()},
      {"p90 ms", before.latency().p90_ms(), after.latency().p90_ms()},
      {"p99 ms", before.latency().p99_ms(), after.latency().p99_ms()},
      {"p99.9 ms", before.latency().p999_ms(), after.latency().p999_ms()},
      {"first data p50 ms", before.first_data().p50_ms(),
       after.first_data().p50_ms()},
      {"refusal p50 ms", before.refusal().p50_ms(), after.refusal().p50_ms()},
      {"server CPUs", before.server().cpus(), after.server().cpus()},
      {"server bytes at most", before.server().memory_peak_bytes(),
       after.server().memory_peak_bytes()}};
  for (ComparedFigure& figure : figures) {
    if (figure.name == "goodput/s") {
      figure.is_worse = figure.after < figure.before * (1 - tolerance);
    } else if (figure.name == "p99 ms") {
      figure.is_worse = before.has_latency() &&
                        figure.after > figure.before * (1 + tolerance);
    }
  }
  return figures;
}

absl::StatusOr<ReportComparison> CompareReports(const BenchReport& before,
                                                const BenchReport& after,
                                                double tolerance) {
  if (before.runs_size() != after.runs_size()) {
    return absl::InvalidArgumentError(
        fmt::format("the reports are of different loads: {} runs against {}",
                    before.runs_size(), after.runs_size()));
  }
  ReportComparison comparison;
  for (int i = 0; i < before.runs_size(); ++i) {
    const absl::Status same = CheckSameLoad(before.runs(i), after.runs(i));
    if (!same.ok()) return same;
    comparison.text +=
        fmt::format("{}\n{:<22}{:>14}{:>14}{:>10}\n", LoopText(after.runs(i)),
                    "", "before", "after", "ratio");
    for (const ComparedFigure& figure :
         Compare(before.runs(i), after.runs(i), tolerance)) {
      if (figure.before <= 0 && figure.after <= 0) continue;
      comparison.text += fmt::format("{:<22}{:>14.6g}{:>14.6g}{:>10}{}\n",
                                     figure.name, figure.before, figure.after,
                                     RatioText(figure.before, figure.after),
                                     figure.is_worse ? "  worse" : "");
      comparison.is_worse |= figure.is_worse;
    }
  }
  return comparison;
}

}  // namespace terrane::client
