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

class LoadTest : public testing::Test {
 protected:
  LoadFigures Run(const LoadOptions& options, std::stop_token stop = {}) {
    const LoadTimes times{LoadClock::now(), milliseconds(50), duration_,
                          deadline_};
    LoadMeter meter(times, mix_.clients);
    end_ = RunLoad(
        options, RequestMix(mix_), &calls_, &meter, [](int) {},
        std::move(stop));
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
  milliseconds duration_{400};
  milliseconds deadline_{500};
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
  EXPECT_LE(figures.offered, 4 * 40 + 4);
  EXPECT_GE(figures.latency.ValueAt(0.01), 9e6);
  EXPECT_EQ(figures.bytes, 64 * figures.good);
  EXPECT_EQ(run_.loop(), "closed");
  EXPECT_NEAR(run_.goodput_per_second(),
              static_cast<double>(figures.good) / 0.4, 1e-6);
}

TEST_F(LoadTest, OpenLoopOffersItsRateWhateverTheAnswersTake) {
  calls_.time = milliseconds(200);
  const LoadFigures figures =
      Run({.rate = 500, .arrivals = ArrivalKind::kEven});
  ExpectSum(figures);
  EXPECT_NEAR(static_cast<double>(figures.offered), 200, 1);
  EXPECT_EQ(figures.not_started, 0);
  EXPECT_EQ(figures.good, figures.offered);
}

TEST_F(LoadTest, WhatHasNoSlotIsNotStarted) {
  calls_.time = milliseconds(100);
  const LoadFigures figures =
      Run({.rate = 500, .arrivals = ArrivalKind::kEven, .max_in_flight = 5});
  ExpectSum(figures);
  EXPECT_GT(figures.not_started, 100);
  EXPECT_LE(figures.started, 5 * 5);
}

TEST_F(LoadTest, CallsThatNeverEndAreCutAndCounted) {
  calls_.time = std::chrono::minutes(10);
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
  const LoadFigures figures = Run({.rate = 500});
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
  // A try more, and the wait that was asked for.
  EXPECT_GE(figures.latency.ValueAt(0.01), 20e6);
}

TEST_F(LoadTest, LateAnswersAreNoGoodput) {
  deadline_ = milliseconds(5);
  calls_.time = milliseconds(20);
  const LoadFigures figures = Run({.concurrency = 2});
  ExpectSum(figures);
  EXPECT_EQ(figures.good, 0);
  EXPECT_EQ(figures.latency.count(), figures.offered);
}

TEST_F(LoadTest, StopEndsAtOnceWithWhatThereIs) {
  duration_ = std::chrono::minutes(10);
  std::stop_source source;
  std::jthread interrupt([&] {
    std::this_thread::sleep_for(milliseconds(300));
    source.request_stop();
  });
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
  const LoadFigures figures = Run({.rate = 500});
  ASSERT_EQ(figures.clients.size(), 3U);
  EXPECT_EQ(figures.clients[0].good, figures.clients[0].offered);
  EXPECT_EQ(figures.clients[2].good, 0);
  EXPECT_EQ(run_.fairness().least_served(), 0);
  EXPECT_NEAR(run_.fairness().jain(), 0.5, 1e-9);
}

TEST(JainIndex, IsOneForEqualSharesAndLessForUnequalOnes) {
  EXPECT_DOUBLE_EQ(JainIndex({3, 3, 3}), 1);
  EXPECT_DOUBLE_EQ(JainIndex({1, 0, 0, 0}), 0.25);
  EXPECT_DOUBLE_EQ(JainIndex({1, 3}), 0.8);
  EXPECT_DOUBLE_EQ(JainIndex({0, 0}), 1);
}

}  // namespace
}  // namespace terrane::client
