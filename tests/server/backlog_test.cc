// When a call would end, by what the others have left to do.
#include "server/service/backlog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "server/service/fair_queue.h"

namespace terrane::server {
namespace {

using std::chrono::milliseconds;

constexpr Backlog::Time kNow{std::chrono::hours(1)};

// Work of the call with that number.
Work Of(const std::string& client, double seconds, std::uint64_t call = 0,
        WorkClass work_class = WorkClass::kInteractive) {
  return {work_class, client, call, seconds, call, true};
}

double Expected(Backlog& backlog, const Work& work, int workers = 1) {
  const Expectation expected = backlog.Expect(work, workers, kNow);
  return expected.work + expected.wait;
}

TEST(BacklogTest, ExpectsTheFinishOfTheFluidModel) {
  Backlog backlog;
  EXPECT_EQ(Expected(backlog, Of("a", 2)), 2);
  // Its tasks come one after the other, however many workers there are.
  EXPECT_EQ(Expected(backlog, Of("a", 2), 4), 2);
  for (std::uint64_t call = 1; call <= 100; ++call) {
    backlog.AddTask(Of("greedy", 1, call));
  }
  // It gets as much as the one who asks, no more; its own goes behind itself.
  EXPECT_EQ(Expected(backlog, Of("a", 2)), 4);
  EXPECT_EQ(Expected(backlog, Of("greedy", 2)), 102);
  EXPECT_EQ(Expected(backlog, Of("greedy", 2), 4), 27);
  backlog.AddTask(Of("small", 0.5, 101));
  EXPECT_EQ(Expected(backlog, Of("a", 2)), 4.5);
  // Batch work in the other class takes a tenth, and no more than it has.
  backlog.AddTask(Of("batch", 0.1, 102, WorkClass::kBatch));
  EXPECT_NEAR(Expected(backlog, Of("a", 2)), 4.6, 1e-9);
  backlog.AddTask(Of("batch", 100, 103, WorkClass::kBatch));
  EXPECT_NEAR(Expected(backlog, Of("a", 2)), 5.0, 1e-9);
}

TEST(BacklogTest, OfInteractiveCallsOnlyTheEarlierOnesComeFirst) {
  Backlog backlog;
  for (std::uint64_t call = 1; call <= 10; ++call) {
    backlog.Set(Of("a", 1, call));
  }
  EXPECT_EQ(Expected(backlog, Of("a", 1, 5)), 5);
  EXPECT_EQ(Expected(backlog, Of("a", 1, 11)), 11);
}

TEST(BacklogTest, BatchCallsOfAClientTakeTurns) {
  Backlog backlog;
  backlog.Set(Of("a", 1000, 1, WorkClass::kBatch));
  backlog.Set(Of("a", 1000, 2, WorkClass::kBatch));
  EXPECT_EQ(Expected(backlog, Of("a", 5, 3, WorkClass::kBatch)), 15);
  // Without a price: when its first message would come.
  EXPECT_EQ(Expected(backlog, Of("a", 0, 3, WorkClass::kBatch)), 0);
}

TEST(BacklogTest, AStreamCountsWhileItsMessageIsOnTheWayButNotForASlowReader) {
  Backlog backlog;
  backlog.AddTask(Of("a", 8, 1));
  backlog.EndTask(Of("a", 8, 1), 1, kNow);
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow), 7);
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow + milliseconds(100)),
            7);
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow + milliseconds(1000)),
            0);
  backlog.AddTask(Of("a", 7, 1));
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow + milliseconds(1000)),
            7);
}

TEST(BacklogTest, TheNextTaskMayComeBeforeTheLastHasEnded) {
  Backlog backlog;
  backlog.AddTask(Of("a", 8, 1));
  backlog.AddTask(Of("a", 7, 1));
  backlog.EndTask(Of("a", 8, 1), 1, kNow);
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow + milliseconds(1000)),
            7);
}

// What Expect promises, call by call.
Expectation ExpectedByDefinition(const std::vector<Work>& calls,
                                 const Work& work, int workers) {
  const bool batch = work.work_class == WorkClass::kBatch;
  double own = work.seconds;
  double of_other_class = 0;
  std::map<std::string, double> others;
  for (const Work& call : calls) {
    if (call.call == work.call) continue;
    if (call.work_class != work.work_class) {
      of_other_class += call.seconds;
    } else if (call.client != work.client) {
      others[call.client] += call.seconds;
    } else if (batch) {
      own += std::min(call.seconds, work.seconds);
    } else if (call.call < work.call) {
      own += call.seconds;
    }
  }
  double ahead = own;
  for (const auto& [client, seconds] : others) ahead += std::min(seconds, own);
  ahead += std::min(ahead * (batch ? 9.0 : 1.0 / 9), of_other_class);
  return {work.seconds, (ahead - work.seconds) / workers};
}

TEST(BacklogTest, SumsAreThoseOfTheCallsThatAreOpen) {
  std::mt19937 random(7);
  const auto one_of = [&](unsigned n) { return random() % n; };
  Backlog backlog;
  std::vector<Work> calls;
  std::uint64_t last_call = 0;
  for (int step = 0; step < 4000; ++step) {
    Work work =
        Of(std::string(1, static_cast<char>('a' + one_of(5))),
           0.25 * static_cast<double>(one_of(9)), ++last_call,
           one_of(2) == 0 ? WorkClass::kInteractive : WorkClass::kBatch);
    if (!calls.empty() && one_of(2) == 0) {  // a call ends, or is set anew
      Work& old = calls[one_of(static_cast<unsigned>(calls.size()))];
      work.call = old.call;
      work.client = old.client;
      std::swap(old, calls.back());
      calls.pop_back();
      if (one_of(3) == 0) backlog.Remove(work.call);
    }
    const Expectation expected = backlog.Expect(work, 2, kNow);
    const Expectation defined = ExpectedByDefinition(calls, work, 2);
    ASSERT_NEAR(expected.wait, defined.wait, 1e-9) << step;
    if (one_of(3) == 0) {
      backlog.Remove(work.call);
    } else {
      backlog.AddTask(work);
      calls.push_back(work);
    }
  }
  for (const Work& call : calls) backlog.Remove(call.call);
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow), 0);
  EXPECT_EQ(backlog.Seconds(WorkClass::kBatch, kNow), 0);
}

TEST(BacklogTest, WhatHasEndedIsGone) {
  Backlog backlog;
  Work alone = Of("a", 8, 1);
  alone.goes_on = false;
  backlog.AddTask(alone);
  backlog.EndTask(alone, 1, kNow);
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow), 0);
  // Removed while its task still waits.
  backlog.AddTask(Of("a", 8, 2));
  backlog.Remove(2);
  backlog.EndTask(Of("a", 8, 2), 1, kNow);
  EXPECT_EQ(backlog.Seconds(WorkClass::kInteractive, kNow), 0);
}

TEST(BacklogTest, TheExpectationHoldsOnASimulatedWorker) {
  Backlog backlog;
  FairQueue queue;
  for (std::uint64_t call = 1; call <= 530; ++call) {
    const Work work = Of(call <= 500 ? "greedy" : "other", 0.01, call);
    backlog.Set(work);
    queue.Push(work, {});
  }
  // 40 tasks whose last one ends the call.
  const double expected = Expected(backlog, Of("mine", 0.4, 531));
  for (int k = 0; k < 40; ++k) queue.Push(Of("mine", 0.01, 531), {});
  double now = 0;
  for (int mine = 0; mine < 40;) {
    const FairQueue::Taken taken = queue.Pop();
    queue.Finish(taken.work, 0.01);
    now += 0.01;
    mine += taken.work.client == "mine" ? 1 : 0;
  }
  EXPECT_NEAR(now, expected, 0.05);
}

}  // namespace
}  // namespace terrane::server
