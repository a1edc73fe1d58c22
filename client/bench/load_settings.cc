#include "client/bench/load_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace terrane::client {
namespace {

// Callers share connections from here on.
constexpr int kMostForCallers = 8;
constexpr int kCallsOfEach = 100;

int Quotient(int calls, int parts) { return (calls + parts - 1) / parts; }

// Calls in flight at a time, at most.
int CallsOf(const BenchOptions& options) {
  const LoadOptions& load = options.load;
  if (!options.sweep.empty()) {
    return std::max(load.concurrency, load.max_in_flight);
  }
  const bool is_open = load.rate > 0 || !options.sweep_rates.empty();
  return is_open ? load.max_in_flight : load.concurrency;
}

std::string MixText(const MixWeights& weights) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < kRequestKinds; ++i) {
    if (weights[i] <= 0) continue;
    parts.push_back(fmt::format("{}={}", kRequestKindNames[i], weights[i]));
  }
  return fmt::format("{}", fmt::join(parts, ","));
}

std::string ListText(const std::vector<double>& values) {
  return values.empty() ? "none" : fmt::format("{}", fmt::join(values, ","));
}

std::string PresetsOwn(const std::optional<int>& value) {
  return value.has_value() ? std::to_string(*value) : "the preset's";
}

std::string SecondsText(std::chrono::duration<double> time) {
  return fmt::format("{}s", time.count());
}

void AddWorkload(const WorkloadOptions& workload, LoadSettings* settings) {
  for (std::size_t i = 0; i < kRequestKinds; ++i) {
    (*settings)[fmt::format("{}-preset", kRequestKindNames[i])] =
        workload.presets[i];
  }
  (*settings)["level"] = PresetsOwn(workload.level);
  (*settings)["tile-size"] = std::to_string(workload.tile_size);
  (*settings)["tiles-per-stream"] = std::to_string(workload.tiles);
  (*settings)["profile-samples"] = std::to_string(workload.profile_samples);
  (*settings)["surface-samples"] = std::to_string(workload.surface_samples);
  (*settings)["tree-depth"] = PresetsOwn(workload.tree_depth);
}

}  // namespace

int ConnectionsOf(const BenchOptions& options) {
  const int calls = CallsOf(options);
  return options.connections.value_or(std::max(std::min(calls, kMostForCallers),
                                               Quotient(calls, kCallsOfEach)));
}

int CallsOfAConnection(const BenchOptions& options) {
  return Quotient(CallsOf(options), ConnectionsOf(options));
}

LoadSettings SettingsOf(const BenchOptions& options) {
  const LoadOptions& load = options.load;
  const MixOptions& mix = options.mix;
  LoadSettings settings = {
      {"concurrency", std::to_string(load.concurrency)},
      {"rate", load.rate > 0 ? fmt::format("{}", load.rate) : "none"},
      {"arrivals", load.arrivals == ArrivalKind::kEven ? "even" : "poisson"},
      {"max-in-flight", std::to_string(load.max_in_flight)},
      {"sweep", ListText(options.sweep)},
      {"sweep-rates", ListText(options.sweep_rates)},
      {"duration", SecondsText(options.duration)},
      {"warm-up", SecondsText(options.warm_up)},
      {"deadline", SecondsText(options.deadline)},
      {"retry", std::to_string(load.retries)},
      {"connections", std::to_string(ConnectionsOf(options))},
      {"mix", MixText(mix.weights)},
      {"cold", fmt::format("{}", mix.cold_share)},
      {"hot-seeds", std::to_string(mix.hot_seeds)},
      {"seed", std::to_string(mix.seed)},
      {"clients", std::to_string(mix.clients)},
      {"greedy", fmt::format("{}", mix.greedy_share)}};
  AddWorkload(options.workload, &settings);
  return settings;
}

}  // namespace terrane::client
