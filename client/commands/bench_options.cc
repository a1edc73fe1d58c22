#include "client/commands/bench_options.h"

#include <fmt/format.h>

#include <chrono>
#include <map>

#include "core/grid/lattice_window.h"

namespace terrane::client {
namespace {

const std::map<std::string, ProgressMode> kProgressModes = {
    {"auto", ProgressMode::kAuto},
    {"none", ProgressMode::kNone},
    {"json", ProgressMode::kJson}};

const std::map<std::string, ArrivalKind> kArrivalKinds = {
    {"poisson", ArrivalKind::kPoisson}, {"even", ArrivalKind::kEven}};

// A number with a unit of time, in seconds.
CLI::Option* AddTime(CLI::App* command, const std::string& name,
                     double* seconds, const std::string& help, double least_s,
                     const char* group) {
  const std::map<std::string, double> units = {
      {"ms", 1e-3}, {"s", 1}, {"m", 60}, {"h", 3600}};
  return command->add_option(name, *seconds, help)
      ->transform(
          CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::DEFAULT, "TIME"))
      ->check(CLI::Range(least_s, 86400.0).description(""))
      ->default_str(fmt::format("{}s", *seconds))
      ->type_name("TIME")
      ->group(group);
}

// Empty when it is a mix, as CLI11 wants it.
std::string CheckMix(const std::string& text) {
  return std::string(ParseMix(text).status().message());
}

constexpr char kLoadGroup[] = "Load";

// `rate` is the option of a single open loop.
void AddSweepOptions(CLI::App* command, CLI::Option* rate,
                     BenchOptions* bench) {
  CLI::Option* sweep =
      command
          ->add_option("--sweep", bench->sweep,
                       "Open loops at these multiples of what the closed loop "
                       "reaches first, and two more to find the knee")
          ->delimiter(',')
          ->check(CLI::Range(1e-3, 1e3))
          ->type_name("FACTOR,...")
          ->excludes(rate)
          ->group(kLoadGroup);
  command
      ->add_option("--sweep-rates", bench->sweep_rates,
                   "Open loops at these requests a second, and no other")
      ->delimiter(',')
      ->check(CLI::Range(1e-3, 1e6))
      ->type_name("RATE,...")
      ->excludes(rate)
      ->excludes(sweep)
      ->group(kLoadGroup);
}

void AddLoadOptions(CLI::App* command, BenchCommand* options) {
  LoadOptions* load = &options->bench.load;
  CLI::Option* callers =
      command
          ->add_option("--concurrency", load->concurrency,
                       "Closed loop: callers, each asks again when answered")
          ->check(CLI::Range(1, 10'000))
          ->capture_default_str()
          ->group(kLoadGroup);
  CLI::Option* rate =
      command
          ->add_option("--rate", load->rate,
                       "Open loop: requests a second, whatever the answers")
          ->check(CLI::Range(1e-3, 1e6))
          ->excludes(callers)
          ->group(kLoadGroup);
  command
      ->add_option("--arrivals", load->arrivals,
                   "Open loop: poisson (independent callers) or even")
      ->transform(OneOf(kArrivalKinds))
      ->type_name("NAME")
      ->default_str("poisson")
      ->group(kLoadGroup);
  command
      ->add_option("--max-in-flight", load->max_in_flight,
                   "Open loop: more calls than that are not started, and "
                   "counted")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str()
      ->group(kLoadGroup);
  AddSweepOptions(command, rate, &options->bench);
  AddTime(command, "--duration", &options->duration_s, "Measured time of a run",
          0.01, kLoadGroup);
  AddTime(command, "--warm-up", &options->warm_up_s,
          "Load before it that is not measured", 0, kLoadGroup);
  AddTime(command, "--deadline", &options->deadline_s,
          "Of each call, from the moment it was due", 1e-3, kLoadGroup);
  command
      ->add_option("--retry", load->retries,
                   "Tries after the first, when refused or not reached")
      ->check(CLI::Range(0, 100))
      ->capture_default_str()
      ->group(kLoadGroup);
  command
      ->add_option("--connections", options->bench.connections,
                   "TCP connections to each replica (default: one for each "
                   "caller, up to 8, and one for every 100 calls in flight)")
      ->check(CLI::Range(1, 1024))
      ->group(kLoadGroup);
}

void AddMixOptions(CLI::App* command, BenchCommand* options) {
  constexpr char kGroup[] = "Requests";
  MixOptions* mix = &options->bench.mix;
  command
      ->add_option("--mix", options->mix,
                   "Kinds by weight: tiles, profiles, surfaces, trees, "
                   "flowers")
      ->check(CheckMix)
      ->type_name("KIND=WEIGHT,...")
      ->capture_default_str()
      ->group(kGroup);
  command
      ->add_option("--cold", mix->cold_share,
                   "Share of requests for recipes not asked for before, 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->group(kGroup);
  command
      ->add_option("--hot-seeds", mix->hot_seeds,
                   "Recipes of each kind that the other requests share")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str()
      ->group(kGroup);
  command
      ->add_option("--seed", mix->seed,
                   "Another sequence of requests: the same seed, the same ones")
      ->capture_default_str()
      ->group(kGroup);
  CLI::Option* clients =
      command
          ->add_option("--clients", mix->clients,
                       "Simulated clients, told apart by x-forwarded-for (a "
                       "server heeds it with --trust-forwarded-for)")
          ->check(CLI::Range(1, 10'000))
          ->capture_default_str()
          ->group(kGroup);
  command
      ->add_option("--greedy", mix->greedy_share,
                   "Share of all requests that the first client sends "
                   "(default: each sends the same)")
      ->check(CLI::Range(0.0, 0.999))
      ->needs(clients)
      ->group(kGroup);
}

void AddPresetOptions(CLI::App* command, WorkloadOptions* workload) {
  constexpr char kGroup[] = "Requests";
  for (std::size_t i = 0; i < kRequestKinds; ++i) {
    command
        ->add_option(fmt::format("--{}-preset", kRequestKindNames[i]),
                     workload->presets[i],
                     fmt::format("Preset of {}", kRequestKindNames[i]))
        ->type_name("NAME")
        ->capture_default_str()
        ->group(kGroup);
  }
  command
      ->add_option("--level", workload->level,
                   "Of tiles and profiles (default: the preset's view)")
      ->check(CLI::Range(0, core::kMaxLevel))
      ->group(kGroup);
  command
      ->add_option("--tile-size", workload->tile_size,
                   "Samples a side of tiles of terrain and surfaces")
      ->check(CLI::Range(1, 8192))
      ->capture_default_str()
      ->group(kGroup);
  command
      ->add_option("--tiles-per-stream", workload->tiles,
                   "Tiles of one request for tiles")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str()
      ->group(kGroup);
  command
      ->add_option("--profile-samples", workload->profile_samples,
                   "Of one request for a profile")
      ->check(CLI::Range(1, 1 << 24))
      ->capture_default_str()
      ->group(kGroup);
  command
      ->add_option("--surface-samples", workload->surface_samples,
                   "Along each axis of a surface")
      ->check(CLI::Range(2, 1 << 20))
      ->capture_default_str()
      ->group(kGroup);
  command
      ->add_option("--tree-depth", workload->tree_depth,
                   "Depth of trees (default: the preset's)")
      ->check(CLI::Range(0, 32))
      ->group(kGroup);
}

void AddReportOptions(CLI::App* command, BenchCommand* options) {
  constexpr char kGroup[] = "Report";
  command
      ->add_option("--json", options->json,
                   "Write the report as JSON (-: standard output)")
      ->type_name("FILE")
      ->group(kGroup);
  command
      ->add_option("--html", options->html,
                   "Write the report as a page with plots that stands alone")
      ->type_name("FILE")
      ->group(kGroup);
  CLI::Option* compare =
      command
          ->add_option("--compare", options->compare,
                       "Earlier --json to compare with; exit code 3 when "
                       "goodput fell or p99 rose")
          ->check(CLI::ExistingFile)
          ->group(kGroup);
  command
      ->add_option("--tolerance", options->tolerance,
                   "By what share they may, 0 to 10")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str()
      ->needs(compare)
      ->group(kGroup);
  CLI::Option* pid =
      command
          ->add_option("--server-pid", options->server_pid,
                       "Process of a server on this machine: its CPU time and "
                       "memory")
          ->check(AboveZero())
          ->group(kGroup);
  command
      ->add_option("--server-metrics", options->server_metrics,
                   "The same out of a server's metrics: "
                   "http://ADDRESS:PORT/metrics")
      ->excludes(pid)
      ->type_name("URL")
      ->group(kGroup);
  command
      ->add_option("--progress", options->bench.progress,
                   "On standard error: auto (a line on a terminal), none or "
                   "json")
      ->transform(OneOf(kProgressModes))
      ->type_name("NAME")
      ->default_str("auto")
      ->group(kGroup);
}

}  // namespace

void AddBenchOptions(CLI::App* command, BenchCommand* options) {
  AddConnectionOptions(command, &options->connection);
  // Only a server can be put under load, and what stalls is to be seen.
  for (const char* name : {"--local", "--threads", "--stall-seconds"}) {
    command->remove_option(command->get_option(name));
  }
  AddLoadOptions(command, options);
  AddMixOptions(command, options);
  AddPresetOptions(command, &options->bench.workload);
  AddReportOptions(command, options);
}

BenchOptions OptionsOf(const BenchCommand& command) {
  using Seconds = std::chrono::duration<double>;
  BenchOptions options = command.bench;
  options.server = command.connection.server;
  options.security = command.connection.security;
  options.mix.weights = *ParseMix(command.mix);  // checked as it was read
  options.warm_up = Seconds(command.warm_up_s);
  options.duration = Seconds(command.duration_s);
  options.deadline = Seconds(command.deadline_s);
  if (command.server_pid.has_value()) {
    options.server_usage = [pid = *command.server_pid] {
      return UsageOfProcess(pid);
    };
  } else if (!command.server_metrics.empty()) {
    options.server_usage = [url = command.server_metrics] {
      return UsageOfMetrics(url);
    };
  }
  return options;
}

}  // namespace terrane::client
