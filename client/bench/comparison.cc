#include "client/bench/comparison.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "client/bench/text_report.h"

namespace terrane::client {
namespace {

constexpr double kFormat = 1;

std::string ValueOf(const LoadSettings& settings, const std::string& name) {
  const auto found = settings.find(name);
  return found == settings.end() ? "nothing" : found->second;
}

std::string RatioText(double before, double after) {
  return before > 0 ? fmt::format("{:.3f}", after / before) : "-";
}

// Empty when neither report has the figure.
std::string FigureLine(const ComparedFigure& figure) {
  if (figure.before <= 0 && figure.after <= 0) return "";
  return fmt::format("{:<22}{:>14.6g}{:>14.6g}{:>10}{}\n", figure.name,
                     figure.before, figure.after,
                     RatioText(figure.before, figure.after),
                     figure.is_worse ? "  worse" : "");
}

std::vector<const BenchRun*> GivenRuns(const BenchReport& report) {
  std::vector<const BenchRun*> runs;
  for (const BenchRun& run : report.runs()) {
    if (!run.searched()) runs.push_back(&run);
  }
  return runs;
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

absl::Status CheckSameLoad(const BenchReport& before,
                           const LoadSettings& settings) {
  if (before.interrupted()) {
    return absl::InvalidArgumentError(
        "the report to compare with is of a test that was interrupted");
  }
  const LoadSettings old(before.settings().begin(), before.settings().end());
  if (old.empty()) {
    return absl::InvalidArgumentError(
        "the report to compare with does not say of which load it is: an "
        "earlier version wrote it");
  }
  std::set<std::string> names;
  for (const LoadSettings* each : {&old, &settings}) {
    for (const auto& [name, value] : *each) names.insert(name);
  }
  std::string differences;
  for (const std::string& name : names) {
    const std::string was = ValueOf(old, name);
    const std::string is = ValueOf(settings, name);
    if (was == is) continue;
    differences += fmt::format("{}{} {} against {}",
                               differences.empty() ? "" : ", ", name, was, is);
  }
  if (differences.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "the report to compare with is of another load: " + differences);
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
      {"p99 with lost ms", before.latency_with_lost().p99_ms(),
       after.latency_with_lost().p99_ms()},
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
    } else if (figure.name.starts_with("p99 ")) {
      figure.is_worse =
          figure.before > 0 && figure.after > figure.before * (1 + tolerance);
    }
  }
  return figures;
}

ReportComparison CompareReports(const BenchReport& before,
                                const BenchReport& after, double tolerance) {
  const std::vector<const BenchRun*> old_runs = GivenRuns(before);
  const std::vector<const BenchRun*> new_runs = GivenRuns(after);
  ReportComparison comparison;
  // Of a sweep there may be fewer, when nothing was good in the first one.
  for (std::size_t i = 0; i < std::min(old_runs.size(), new_runs.size()); ++i) {
    comparison.text +=
        fmt::format("{}\n{:<22}{:>14}{:>14}{:>10}\n", LoopText(*new_runs[i]),
                    "", "before", "after", "ratio");
    for (const ComparedFigure& figure :
         Compare(*old_runs[i], *new_runs[i], tolerance)) {
      comparison.text += FigureLine(figure);
      comparison.is_worse |= figure.is_worse;
    }
  }
  comparison.text +=
      FigureLine({"knee/s", before.sweep().knee(), after.sweep().knee()});
  return comparison;
}

}  // namespace terrane::client
