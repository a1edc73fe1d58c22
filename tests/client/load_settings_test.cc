#include "client/bench/load_settings.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace terrane::client {
namespace {

TEST(Connections, AreOneForEachCallerUpToEight) {
  for (const auto& [callers, connections] :
       {std::pair(1, 1), std::pair(5, 5), std::pair(8, 8), std::pair(16, 8),
        std::pair(800, 8), std::pair(801, 9), std::pair(10'000, 100)}) {
    BenchOptions options;
    options.load.concurrency = callers;
    EXPECT_EQ(ConnectionsOf(options), connections) << callers;
  }
}

TEST(Connections, OfAnOpenLoopAreEnoughForTheCallsInFlight) {
  BenchOptions options;
  options.load.rate = 50;
  EXPECT_EQ(ConnectionsOf(options), 11);  // of 1024 calls
  options.load.rate = 0;
  EXPECT_EQ(ConnectionsOf(options), 8);
  options.sweep = {1, 2};
  EXPECT_EQ(ConnectionsOf(options), 11);
  options.load.concurrency = 2000;  // of the closed loop before
  EXPECT_EQ(ConnectionsOf(options), 20);
  options.sweep = {};
  options.sweep_rates = {10};
  options.load.max_in_flight = 3;
  EXPECT_EQ(ConnectionsOf(options), 3);
}

TEST(Connections, AreAsManyAsWereAskedFor) {
  BenchOptions options;
  options.load.concurrency = 1000;
  EXPECT_EQ(CallsOfAConnection(options), 100);
  options.connections = 3;
  EXPECT_EQ(ConnectionsOf(options), 3);
  EXPECT_EQ(CallsOfAConnection(options), 334);
}

TEST(Settings, EveryOptionOfTheLoadShowsInItsOwn) {
  using Change = std::function<void(BenchOptions*)>;
  const std::vector<std::pair<std::string, Change>> changes = {
      {"concurrency", [](auto* o) { o->load.concurrency = 7; }},
      {"rate", [](auto* o) { o->load.rate = 12.5; }},
      {"arrivals", [](auto* o) { o->load.arrivals = ArrivalKind::kEven; }},
      {"max-in-flight", [](auto* o) { o->load.max_in_flight = 7; }},
      {"sweep",
       [](auto* o) {
         o->sweep = {1, 2};
       }},
      {"sweep-rates",
       [](auto* o) {
         o->sweep_rates = {1, 2};
       }},
      {"duration", [](auto* o) { o->duration = std::chrono::seconds(1); }},
      {"warm-up", [](auto* o) { o->warm_up = std::chrono::seconds(1); }},
      {"deadline", [](auto* o) { o->deadline = std::chrono::seconds(1); }},
      {"retry", [](auto* o) { o->load.retries = 1; }},
      {"connections", [](auto* o) { o->connections = 3; }},
      {"mix",
       [](auto* o) {
         o->mix.weights = {1, 0, 0, 2, 0};
       }},
      {"cold", [](auto* o) { o->mix.cold_share = 0.5; }},
      {"hot-seeds", [](auto* o) { o->mix.hot_seeds = 3; }},
      {"seed", [](auto* o) { o->mix.seed = 3; }},
      {"clients", [](auto* o) { o->mix.clients = 3; }},
      {"greedy", [](auto* o) { o->mix.greedy_share = 0.5; }},
      {"tiles-preset", [](auto* o) { o->workload.presets[0] += "-old"; }},
      {"profiles-preset", [](auto* o) { o->workload.presets[1] += "-old"; }},
      {"surfaces-preset", [](auto* o) { o->workload.presets[2] += "-old"; }},
      {"trees-preset", [](auto* o) { o->workload.presets[3] += "-old"; }},
      {"flowers-preset", [](auto* o) { o->workload.presets[4] += "-old"; }},
      {"level", [](auto* o) { o->workload.level = 3; }},
      {"tile-size", [](auto* o) { o->workload.tile_size = 3; }},
      {"tiles-per-stream", [](auto* o) { o->workload.tiles = 3; }},
      {"profile-samples", [](auto* o) { o->workload.profile_samples = 3; }},
      {"surface-samples", [](auto* o) { o->workload.surface_samples = 3; }},
      {"tree-depth", [](auto* o) { o->workload.tree_depth = 3; }}};
  // So that the number of connections does not follow.
  BenchOptions base;
  base.connections = 2;
  const LoadSettings before = SettingsOf(base);
  std::set<std::string> names;
  for (const auto& [name, change] : changes) {
    BenchOptions options = base;
    change(&options);
    LoadSettings after = SettingsOf(options);
    EXPECT_NE(after.at(name), before.at(name)) << name;
    after[name] = before.at(name);
    EXPECT_EQ(after, before) << name;
    names.insert(name);
  }
  EXPECT_EQ(names.size(), before.size());
}

TEST(Settings, ReadAsOnTheCommandLine) {
  BenchOptions options;
  options.mix.weights = {8, 0, 0, 0.5, 0};
  options.sweep = {0.5, 2};
  const LoadSettings settings = SettingsOf(options);
  EXPECT_EQ(settings.at("mix"), "tiles=8,trees=0.5");
  EXPECT_EQ(settings.at("sweep"), "0.5,2");
  EXPECT_EQ(settings.at("rate"), "none");
  EXPECT_EQ(settings.at("deadline"), "5s");
  EXPECT_EQ(settings.at("level"), "the preset's");
}

TEST(Settings, AreTheSameForAnotherServer) {
  BenchOptions options;
  const LoadSettings before = SettingsOf(options);
  options.server = "elsewhere:50051";
  options.progress = ProgressMode::kJson;
  EXPECT_EQ(SettingsOf(options), before);
}

}  // namespace
}  // namespace terrane::client
