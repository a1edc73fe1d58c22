// `terrane bench`: the load tester.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <memory>

#include "client/bench/bench_run.h"
#include "client/bench/comparison.h"
#include "client/bench/html_report.h"
#include "client/bench/load_settings.h"
#include "client/bench/outcome.h"
#include "client/bench/text_report.h"
#include "client/commands/bench_options.h"
#include "client/commands/command.h"
#include "client/csv.h"
#include "client/exit_code.h"
#include "client/output_file.h"

namespace terrane::client {
namespace {

constexpr char kFooter[] = R"(Examples:
  terrane bench --concurrency 32 --duration 10s
  terrane bench --rate 200 --deadline 0.5s --json run.json --html run.html
  terrane bench --mix tiles=8,profiles=1,surfaces=1,trees=1,flowers=1 --cold 0.2
  terrane bench --sweep 0.5,1,2,4,8 --deadline 0.5s --clients 4 --html sweep.html
  terrane bench --concurrency 32 --compare run.json --tolerance 0.05
Times take a unit: 500ms, 10s, 2m. An answer that a verifier finds damaged counts
as DATA_LOSS. Exit codes: 0 ok; 1 error, any answer damaged, or no call that ended
well; 2 usage, or --compare with the report of another load; 3 worse than --compare;
4 unreachable, or nothing but UNAVAILABLE came; 130 interrupted (with the results so
far). Reports are written in all of these cases once the load has begun.)";

// --compare: goodput fell or latency rose.
constexpr int kExitWorse = 3;
// Calls that terrane-server takes of one connection.
constexpr int kServerCalls = 256;

std::string NowText() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(
                         std::chrono::system_clock::now())));
}

// OK when every report can be made: tried and taken back.
absl::Status CheckWritable(const BenchCommand& command) {
  for (const std::string& path : {command.json, command.html}) {
    if (path.empty() || path == "-") continue;
    if (const auto file = OutputFile::Create(path); !file.ok()) {
      return file.status();
    }
  }
  return absl::OkStatus();
}

absl::Status WriteReports(const BenchCommand& command,
                          const BenchReport& report) {
  absl::Status status;
  if (!command.json.empty()) {
    status = WriteText(command.json, JsonLine(report) + '\n');
  }
  if (status.ok() && !command.html.empty()) {
    status = WriteText(command.html, HtmlReport(report));
  }
  return status;
}

// A queue in this process looks like the server's latency.
void WarnOfQueue(const BenchOptions& options) {
  const int calls = CallsOfAConnection(options);
  if (calls <= kServerCalls) return;
  std::cerr << fmt::format(
      "terrane: warning: up to {} calls to a connection, of which a server "
      "takes {}: the others wait here; give more --connections\n",
      calls, kServerCalls);
}

int Run(const BenchCommand& command, std::stop_token stop) {
  // Before the load: a report that is missing, or of another load, or cannot be
  // written, must not cost a run.
  const absl::Status writable = CheckWritable(command);
  if (!writable.ok()) return ReportStatus(writable);
  const BenchOptions options = OptionsOf(command);
  absl::StatusOr<BenchReport> before = BenchReport();
  if (!command.compare.empty()) {
    before = ReadReport(command.compare);
    if (!before.ok()) return ReportStatus(before.status());
    const absl::Status same = CheckSameLoad(*before, SettingsOf(options));
    if (!same.ok()) {
      ReportStatus(same);
      return kExitUsage;
    }
  }
  WarnOfQueue(options);
  const std::unique_ptr<Backend> backend = MakeBackend(command.connection);
  // JSON on standard output leaves no room for text there.
  std::ostream& text =
      command.json == "-" || command.html == "-" ? std::cerr : std::cout;
  const std::string started = NowText();
  absl::StatusOr<BenchReport> report = RunBench(
      options, backend.get(),
      [&](const BenchRun& run) { text << RunText(run) << std::endl; }, stop);
  if (!report.ok()) return ReportStatus(report.status());
  report->set_format(1);
  report->set_version(command.version);
  report->set_server(command.connection.server);
  report->set_started(started);
  if (report->has_sweep()) text << SweepMarkdown(*report);
  const absl::Status written = WriteReports(command, *report);
  if (!written.ok()) return ReportStatus(written);
  const absl::Status outcome = OutcomeOf(*report);
  if (!outcome.ok()) return ReportStatus(outcome);
  if (command.compare.empty()) return kExitOk;
  const ReportComparison comparison =
      CompareReports(*before, *report, command.tolerance);
  text << comparison.text;
  return comparison.is_worse ? kExitWorse : kExitOk;
}

}  // namespace

void AddBenchCommand(CLI::App* app, Action* action) {
  CLI::App* subcommand =
      app->add_subcommand("bench", "Put a server under load and measure it");
  const auto command = std::make_shared<BenchCommand>();
  command->version = app->version();
  AddBenchOptions(subcommand, command.get());
  subcommand->footer(kFooter);
  subcommand->final_callback([command, action] {
    *action = [command](std::stop_token stop) { return Run(*command, stop); };
  });
}

}  // namespace terrane::client
