// The options of `terrane bench`.
#ifndef TERRANE_CLIENT_COMMANDS_BENCH_OPTIONS_H_
#define TERRANE_CLIENT_COMMANDS_BENCH_OPTIONS_H_

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "client/bench/bench_run.h"
#include "client/commands/shared_options.h"

namespace terrane::client {

struct BenchCommand {
  ConnectionOptions connection;
  BenchOptions bench;
  std::string mix = "tiles";
  double warm_up_s = 2;
  double duration_s = 10;
  double deadline_s = 5;
  std::optional<int> server_pid;
  std::string server_metrics;  // URL
  std::string json;
  std::string html;
  std::string compare;
  double tolerance = 0.1;
  std::string version;  // of this program
};

void AddBenchOptions(CLI::App* command, BenchCommand* options);

// What the options say together.
BenchOptions OptionsOf(const BenchCommand& command);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_BENCH_OPTIONS_H_
