#include "client/bench/outcome.h"

#include <fmt/format.h>

#include <map>
#include <string>

namespace terrane::client {
namespace {

struct CodeTotal {
  double count = 0;
  std::string example;
};

std::map<std::string, CodeTotal> TotalsOf(const BenchReport& report) {
  std::map<std::string, CodeTotal> totals;
  for (const BenchRun& run : report.runs()) {
    for (const CodeCount& codes : run.codes()) {
      CodeTotal& total = totals[codes.code()];
      total.count += codes.count();
      if (total.example.empty()) total.example = codes.example();
    }
  }
  return totals;
}

}  // namespace

absl::Status OutcomeOf(const BenchReport& report) {
  double damaged = 0;
  double offered = 0;
  for (const BenchRun& run : report.runs()) {
    damaged += run.damaged();
    offered += run.offered();
  }
  std::map<std::string, CodeTotal> totals = TotalsOf(report);
  if (damaged > 0) {
    const std::string& example = totals["DATA_LOSS"].example;
    return absl::DataLossError(
        fmt::format("{:.0f} answers were damaged{}{}", damaged,
                    example.empty() ? "" : ", such as: ", example));
  }
  if (report.interrupted()) return absl::CancelledError("interrupted");
  if (offered == 0 || totals.contains("OK")) return absl::OkStatus();
  std::string text = fmt::format("none of {:.0f} calls ended well", offered);
  for (const auto& [code, total] : totals) {
    text += fmt::format("; {:.0f} {}: {}", total.count, code, total.example);
  }
  return totals.size() == 1 && totals.contains("UNAVAILABLE")
             ? absl::UnavailableError(text)
             : absl::UnknownError(text);
}

}  // namespace terrane::client
