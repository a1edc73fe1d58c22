// RunBench, from its options to its report, against a server that does as a
// test says.
#include "client/bench/bench_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "client/bench/outcome.h"
#include "client/remote_backend.h"
#include "tests/client/damaging_server.h"

namespace terrane::client {
namespace {

using testing::HasSubstr;

class BenchRunTest : public testing::Test {
 protected:
  BenchRunTest() {
    options_.server = server_.address();
    options_.workload.tile_size = 1;
    options_.workload.tiles = 2;
    options_.warm_up = std::chrono::milliseconds(100);
    options_.duration = std::chrono::milliseconds(500);
    options_.deadline = std::chrono::minutes(1);
    options_.progress = ProgressMode::kNone;
    options_.load.concurrency = 2;
  }

  BenchReport Run(
      const OnRun& on_run = [](const BenchRun&) {}, std::stop_token stop = {}) {
    RemoteBackend backend(server_.address());
    return RunBench(options_, &backend, on_run, std::move(stop)).value();
  }

  DamagingServer server_;
  BenchOptions options_;
};

TEST_F(BenchRunTest, DamageIsTheOutcome) {
  options_.duration = std::chrono::seconds(3);
  EXPECT_TRUE(OutcomeOf(Run()).ok());
  server_.fault = Fault::kDamagedTile;
  const absl::Status outcome = OutcomeOf(Run());
  EXPECT_EQ(outcome.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(outcome.message()), HasSubstr("checksum"));
}

TEST_F(BenchRunTest, NothingButUnavailableIsTheOutcome) {
  options_.duration = std::chrono::seconds(3);
  server_.fault = Fault::kUnavailable;
  const absl::Status outcome = OutcomeOf(Run());
  EXPECT_EQ(outcome.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(outcome.message()), HasSubstr("not now"));
}

TEST_F(BenchRunTest, ConnectionsAreThoseOfTheReport) {
  options_.load.concurrency = 3;
  const BenchReport report = Run();
  EXPECT_EQ(report.runs(0).connections(), 3);
  EXPECT_EQ(report.settings().at("connections"), "3");
  // One more fetched the preset, and sent no request for tiles.
  EXPECT_EQ(server_.peers().size(), 3U);
}

TEST_F(BenchRunTest, SweepTriesTwoRatesBetweenGoodAndBad) {
  // A fiftieth of what one caller reaches is served, sixteen times that is not.
  options_.sweep = {16, 0.02};
  options_.load.concurrency = 1;
  options_.load.max_in_flight = 100;
  const BenchReport report = Run();
  ASSERT_EQ(report.runs_size(), 5);
  EXPECT_EQ(report.runs(0).loop(), "closed");
  const double low = report.runs(1).rate();
  const double high = report.runs(2).rate();
  EXPECT_NEAR(high / low, 800, 1e-6);
  EXPECT_FALSE(report.runs(2).searched());
  EXPECT_NEAR(report.runs(3).rate(), std::sqrt(low * high), 1e-6);
  EXPECT_TRUE(report.runs(3).searched());
  EXPECT_TRUE(report.runs(4).searched());
  EXPECT_GT(report.runs(4).rate(), low);
  EXPECT_LT(report.runs(4).rate(), high);
  EXPECT_GT(report.sweep().knee(), 0);
  EXPECT_GT(report.sweep().beyond_knee(), report.sweep().knee());
}

TEST_F(BenchRunTest, InterruptedRateOfASweepDoesNotCount) {
  options_.sweep_rates = {50, 60};
  std::stop_source stop;
  const BenchReport report =
      Run([&](const BenchRun&) { stop.request_stop(); }, stop.get_token());
  ASSERT_EQ(report.runs_size(), 2);
  EXPECT_TRUE(report.interrupted());
  EXPECT_FALSE(report.runs(0).interrupted());
  EXPECT_TRUE(report.runs(1).interrupted());
  EXPECT_EQ(report.sweep().last_goodput(), report.runs(0).goodput_per_second());
}

}  // namespace
}  // namespace terrane::client
