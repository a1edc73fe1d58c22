// RunLoad against calls that end as the tests say, without a network.
#include "client/bench/load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "client/bench/summary.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

// Ends after a while with a given result, in a thread of its own; or when it is
// cancelled.
class FakeCall : public LoadCall {
 public:
  FakeCall(milliseconds time, CallResult result, OnResult on_result)
      : time_(time), result_(result), on_result_(std::move(on_result)) {}

  void Start() override {
    // The state outlives the call, as gRPC's does.
    std::thread([state = state_, time = time_, result = result_,
                 on_result = std::move(on_result_)]() mutable {
      {
        std::unique_lock lock(state->mutex);
        if (state->changed.wait_for(lock, time,
                                    [&] { return state->cancelled; })) {
          result.code = grpc::StatusCode::CANCELLED;
        }
      }
      result.end = LoadClock::now();
      on_result(result);
    }).detach();
  }
  void Cancel() override {
    const std::lock_guard lock(state_->mutex);
    state_->cancelled = true;
    state_->changed.notify_all();
  }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    bool cancelled = false;
  };
  const std::shared_ptr<State> state_ = std::make_shared<State>();
  const milliseconds time_;
  const CallResult result_;
  OnResult on_result_;
};

class FakeCalls : public CallMaker {
 public:
  std::unique_ptr<LoadCall> Make(const PlannedRequest& plan,
                                 LoadClock::time_point,
                                 LoadCall::OnResult on_result) override {
    ++made;
    return std::make_unique<FakeCall>(time, result_of(plan),
                                      std::move(on_result));
  }

  milliseconds time{1};
  std::function<CallResult(const PlannedRequest&)> result_of =
      [](const PlannedRequest&) {
        return CallResult{.tiles = 1, .samples = 16, .bytes = 64};
      };
  std::atomic<int> made = 0;
};

// More than a machine that stands still for a while leaves waiting.
constexpr int kNoLimit = 10'000;

class LoadTest : public testing::Test {
 protected:
  LoadFigures Run(const LoadOptions& options, std::stop_token stop = {}) {
    const LoadTimes times{LoadClock::now(), milliseconds(50), duration_,
                          deadline_};
    LoadMeter meter(times, mix_.clients);
    end_ = RunLoad(
        options, RequestMix(mix_), &calls_, &meter,
        [&](int) { on_tick_(meter); }, std::move(stop));
    LoadFigures figures = meter.figures();
    run_ = Summarize(options, times, mix_, figures, duration_);
    return figures;
  }

  // Every offered request ends in exactly one way.
  static void ExpectSum(const LoadFigures& figures) {
    std::int64_t ended = figures.not_started + figures.unfinished;
    for (const auto& [code, count] : figures.codes) ended += count;
    EXPECT_EQ(ended, figures.offered);
    EXPECT_EQ(figures.started + figures.not_started, figures.offered);
    EXPECT_GT(figures.offered, 0);
  }

  FakeCalls calls_;
  MixOptions mix_;
  // Long enough for some requests on a machine that stands still for a second.
  milliseconds duration_ = std::chrono::seconds(3);
  // So long that no machine is late; tests of deadlines have their own.
  milliseconds deadline_ = std::chrono::minutes(1);
  std::function<void(const LoadMeter&)> on_tick_ = [](const LoadMeter&) {};
  LoadEnd end_ = LoadEnd::kComplete;
  BenchRun run_;
};

TEST_F(LoadTest, ClosedLoopKeepsItsCallersBusy) {
  calls_.time = milliseconds(10);
  const LoadFigures figures = Run({.concurrency = 4});
  ExpectSum(figures);
  EXPECT_EQ(end_, LoadEnd::kComplete);
  EXPECT_EQ(figures.good, figures.offered);
  // No caller asks again before it is answered.
  EXPECT_LE(figures.offered, 4 * 300 + 4);
  EXPECT_GE(figures.latency.ValueAt(0.01), 9e6);
  EXPECT_EQ(figures.bytes, 64 * figures.good);
  EXPECT_EQ(run_.loop(), "closed");
  EXPECT_NEAR(run_.goodput_per_second(), static_cast<double>(figures.good) / 3,
              1e-6);
}

TEST_F(LoadTest, OpenLoopOffersItsRateWhateverTheAnswersTake) {
  calls_.time = milliseconds(200);
  duration_ = milliseconds(400);
  const LoadFigures figures = Run(
      {.rate = 500, .arrivals = ArrivalKind::kEven, .max_in_flight = kNoLimit});
  ExpectSum(figures);
  EXPECT_NEAR(static_cast<double>(figures.offered), 200, 1);
  EXPECT_EQ(figures.not_started, 0);
  EXPECT_EQ(figures.good, figures.offered);
}

TEST_F(LoadTest, WhatHasNoSlotIsNotStarted) {
  calls_.time = milliseconds(100);
  duration_ = milliseconds(400);
  const LoadFigures figures =
      Run({.rate = 500, .arrivals = ArrivalKind::kEven, .max_in_flight = 5});
  ExpectSum(figures);
  EXPECT_GT(figures.not_started, 100);
  EXPECT_LE(figures.started, 5 * 5);
}

TEST_F(LoadTest, CallsThatNeverEndAreCutAndCounted) {
  calls_.time = std::chrono::minutes(10);
  duration_ = milliseconds(400);
  deadline_ = milliseconds(50);
  const LoadFigures figures = Run({.concurrency = 3, .max_in_flight = 1});
  EXPECT_EQ(figures.good, 0);
  EXPECT_EQ(calls_.made, 3);
  const LoadFigures open = Run({.rate = 100, .max_in_flight = 10});
  ExpectSum(open);
  EXPECT_GT(open.unfinished + open.not_started, 0);
  EXPECT_EQ(open.good, 0);
}

TEST_F(LoadTest, RefusalsHaveTheirOwnCodeAndLatency) {
  calls_.result_of = [](const PlannedRequest& plan) {
    if (plan.number % 2 == 0) return CallResult{};
    return CallResult{.code = grpc::StatusCode::RESOURCE_EXHAUSTED,
                      .message = "too much"};
  };
  duration_ = milliseconds(400);
  const LoadFigures figures = Run({.rate = 500, .max_in_flight = kNoLimit});
  ExpectSum(figures);
  const std::int64_t refused =
      figures.codes.at(grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NEAR(static_cast<double>(refused),
              static_cast<double>(figures.offered) / 2, 2);
  EXPECT_EQ(figures.refusal.count(), refused);
  EXPECT_EQ(figures.latency.count() + refused, figures.offered);
  EXPECT_EQ(figures.examples.at(grpc::StatusCode::RESOURCE_EXHAUSTED),
            "too much");
}

TEST_F(LoadTest, RetriesHelpWhereTheServerSaysSo) {
  std::atomic<int> refusals = 0;
  calls_.result_of = [&](const PlannedRequest&) {
    if (++refusals % 2 == 0) return CallResult{};
    return CallResult{.code = grpc::StatusCode::RESOURCE_EXHAUSTED,
                      .retry_delay = milliseconds(5)};
  };
  const LoadFigures figures = Run({.concurrency = 1, .retries = 1});
  ExpectSum(figures);
  EXPECT_EQ(figures.good, figures.offered);
  EXPECT_EQ(figures.retries, figures.offered);
  // Half of the first wait at least, and the wait that was asked for.
  EXPECT_GE(figures.latency.ValueAt(0.01), 54e6);
}

TEST_F(LoadTest, CallersOfAServerThatIsGoneAskTenTimesASecond) {
  calls_.time = milliseconds(0);
  calls_.result_of = [](const PlannedRequest&) {
    return CallResult{.code = grpc::StatusCode::UNAVAILABLE};
  };
  const LoadFigures figures = Run({.concurrency = 2});
  ExpectSum(figures);
  EXPECT_LE(figures.offered, 2 * 30 + 2);
  EXPECT_GT(calls_.made, 2);
}

TEST_F(LoadTest, LateAnswersAreNoGoodput) {
  deadline_ = milliseconds(5);
  calls_.time = milliseconds(20);
  const LoadFigures figures = Run({.concurrency = 2});
  ExpectSum(figures);
  EXPECT_EQ(figures.good, 0);
  EXPECT_GT(figures.latency.count(), 0);
  EXPECT_EQ(figures.latency.count() + figures.unfinished, figures.offered);
}

TEST_F(LoadTest, StopEndsAtOnceWithWhatThereIs) {
  duration_ = std::chrono::minutes(10);
  std::stop_source source;
  on_tick_ = [&](const LoadMeter& meter) {
    if (meter.figures().good > 0) source.request_stop();
  };
  const LoadFigures figures = Run({.concurrency = 2}, source.get_token());
  ExpectSum(figures);
  EXPECT_EQ(end_, LoadEnd::kStopped);
  EXPECT_GT(figures.good, 0);
}

TEST_F(LoadTest, ClientsAreCountedApart) {
  mix_.clients = 3;
  mix_.greedy_share = 0.8;
  calls_.result_of = [](const PlannedRequest& plan) {
    if (plan.client != 2) return CallResult{};
    return CallResult{.code = grpc::StatusCode::DEADLINE_EXCEEDED};
  };
  duration_ = milliseconds(400);
  const LoadFigures figures = Run({.rate = 500, .max_in_flight = kNoLimit});
  ASSERT_EQ(figures.clients.size(), 3U);
  EXPECT_EQ(figures.clients[0].good, figures.clients[0].offered);
  EXPECT_EQ(figures.clients[2].good, 0);
  EXPECT_EQ(run_.fairness().least_served(), 0);
  EXPECT_NEAR(run_.fairness().jain(), 0.5, 1e-9);
}

TEST(JainIndex, IsOneForEqualSharesAndLessForUnequalOnes) {
  EXPECT_DOUBLE_EQ(JainIndex({3, 3, 3}).value(), 1);
  EXPECT_DOUBLE_EQ(JainIndex({1, 0, 0, 0}).value(), 0.25);
  EXPECT_DOUBLE_EQ(JainIndex({1, 3}).value(), 0.8);
  EXPECT_FALSE(JainIndex({0, 0}).has_value());
  EXPECT_FALSE(JainIndex({}).has_value());
}

// The meter alone, at times that the tests make up.
class LoadMeterTest : public testing::Test {
 protected:
  static constexpr std::chrono::seconds kDeadline{5};

  LoadMeterTest() : meter_(times_, mix_.clients) {}

  LoadClock::time_point Measured() const { return times_.measured_from(); }
  // A request that is due at a time and ends so long after it.
  void End(LoadClock::time_point due, milliseconds latency,
           grpc::StatusCode code, int client = 0) {
    const PlannedRequest plan{.client = client};
    meter_.Started(plan, due);
    meter_.Ended(plan, due, due, {.code = code, .end = due + latency});
  }
  BenchRun Run() const {
    return Summarize({}, times_, mix_, meter_.figures(), times_.duration);
  }

  const LoadTimes times_{LoadClock::now() - std::chrono::minutes(1),
                         std::chrono::seconds(1), std::chrono::seconds(10),
                         kDeadline};
  MixOptions mix_{.clients = 4};
  LoadMeter meter_;
};

TEST_F(LoadMeterTest, WhatTimeRanOutForIsInTheSecondSetOfPercentiles) {
  for (int i = 0; i < 6; ++i) {
    End(Measured(), milliseconds(10), grpc::StatusCode::OK);
  }
  End(Measured(), milliseconds(4'999), grpc::StatusCode::DEADLINE_EXCEEDED);
  End(Measured(), milliseconds(1), grpc::StatusCode::RESOURCE_EXHAUSTED);
  meter_.NotStarted({}, Measured());
  meter_.Started({}, Measured());
  meter_.Unfinished(Measured());
  const BenchRun run = Run();
  EXPECT_EQ(run.latency().count(), 6);
  EXPECT_NEAR(run.latency().max_ms(), 10, 1e-6);
  // Nine without the refusal, a third of which had no answer in time.
  EXPECT_EQ(run.latency_with_lost().count(), 9);
  EXPECT_NEAR(run.latency_with_lost().p50_ms(), 10, 0.1);
  EXPECT_GE(run.latency_with_lost().p90_ms(), 4'990);
  // The one that was cut had waited from when it was due, a minute ago.
  EXPECT_GT(run.latency_with_lost().max_ms(), 50'000);
}

TEST_F(LoadMeterTest, DamageCountsBeforeTheMeasuredTimeToo) {
  End(times_.start, milliseconds(1), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(Run().damaged(), 1);
  EXPECT_EQ(Run().offered(), 0);
  End(Measured(), milliseconds(1), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(Run().damaged(), 2);
  EXPECT_EQ(Run().codes_size(), 1);
}

TEST_F(LoadMeterTest, FairnessIsOverWhatEachClientAskedFor) {
  // Half of what each asks for, little or much; the last one asks for nothing.
  for (const auto& [client, pairs] :
       {std::pair(0, 1), std::pair(1, 5), std::pair(2, 20)}) {
    for (int i = 0; i < pairs; ++i) {
      End(Measured(), milliseconds(1), grpc::StatusCode::OK, client);
      End(Measured(), milliseconds(1), grpc::StatusCode::INTERNAL, client);
    }
  }
  const BenchRun run = Run();
  EXPECT_NEAR(run.fairness().jain(), 1, 1e-9);
  EXPECT_NEAR(run.fairness().least_served(), 0.5, 1e-9);
  EXPECT_EQ(run.fairness().clients_size(), 4);
}

TEST_F(LoadMeterTest, NothingIsFairWhereNothingIsGood) {
  EXPECT_FALSE(Run().has_fairness());
  for (int client = 0; client < 4; ++client) {
    End(Measured(), milliseconds(1), grpc::StatusCode::UNAVAILABLE, client);
  }
  EXPECT_TRUE(Run().has_fairness());
  EXPECT_FALSE(Run().fairness().has_jain());
  EXPECT_EQ(Run().fairness().least_served(), 0);
}

}  // namespace
}  // namespace terrane::client
