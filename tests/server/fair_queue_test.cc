// Whose turn it is, on a simulated worker.
#include "server/service/fair_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "server/service/price_book.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;

Work Of(const std::string& client, double seconds,
        WorkClass work_class = WorkClass::kInteractive,
        std::uint64_t ticket = 0) {
  return {work_class, client, ticket, seconds};
}

void Push(FairQueue* queue, const Work& work, int count = 1) {
  for (int k = 0; k < count; ++k) queue->Push(work, {});
}

// One worker takes `count` tasks, which take what they said; who was served.
std::vector<std::string> Serve(FairQueue* queue, int count) {
  std::vector<std::string> served;
  for (int k = 0; k < count; ++k) {
    const FairQueue::Taken taken = queue->Pop();
    queue->Finish(taken.work, taken.work.seconds);
    served.push_back(taken.work.client);
  }
  return served;
}

std::map<std::string, int> Count(const std::vector<std::string>& served) {
  std::map<std::string, int> counts;
  for (const std::string& client : served) ++counts[client];
  return counts;
}

TEST(FairQueueTest, ClientsTakeTurnsWhateverTheyQueued) {
  FairQueue queue;
  Push(&queue, Of("greedy", 1), 100);
  Push(&queue, Of("polite", 1), 3);
  EXPECT_EQ(Count(Serve(&queue, 6))["polite"], 3);
  Serve(&queue, 97);
  EXPECT_TRUE(queue.empty());
}

TEST(FairQueueTest, TimeIsSharedNotTasks) {
  FairQueue queue;
  Push(&queue, Of("slow", 4), 50);
  Push(&queue, Of("quick", 1), 200);
  const auto counts = Count(Serve(&queue, 100));
  EXPECT_NEAR(counts.at("quick") / static_cast<double>(counts.at("slow")), 4,
              0.2);
}

TEST(FairQueueTest, WhatATaskReallyTookIsCharged) {
  FairQueue queue;
  // Says 1 ms and takes a second.
  Push(&queue, Of("liar", 1e-3), 50);
  Push(&queue, Of("honest", 1), 50);
  std::vector<std::string> served;
  for (int k = 0; k < 40; ++k) {
    const FairQueue::Taken taken = queue.Pop();
    queue.Finish(taken.work, 1);
    served.push_back(taken.work.client);
  }
  EXPECT_EQ(Count(served)["honest"], 20);
}

TEST(FairQueueTest, WhoWasAwayHasNoCreditForIt) {
  FairQueue queue;
  Push(&queue, Of("a", 1), 100);
  Serve(&queue, 50);
  Push(&queue, Of("b", 1), 50);
  EXPECT_EQ(Count(Serve(&queue, 20))["b"], 10);
}

TEST(FairQueueTest, WhoComesBackEachTimeKeepsItsDebt) {
  // A stream has one task at a time: it leaves and comes back.
  FairQueue queue;
  Push(&queue, Of("many", 1), 100);
  int served = 0;
  Push(&queue, Of("one", 3));
  for (int k = 0; k < 60; ++k) {
    const FairQueue::Taken taken = queue.Pop();
    const bool one = taken.work.client == "one";
    queue.Finish(taken.work, taken.work.seconds);
    if (one) {
      ++served;
      Push(&queue, Of("one", 3));
    }
  }
  EXPECT_NEAR(served, 15, 1);
}

TEST(FairQueueTest, OfAClientTheLowestTicketComesFirst) {
  FairQueue queue;
  for (const std::uint64_t ticket : {3U, 1U, 2U}) {
    queue.Push({WorkClass::kInteractive, "a", ticket, 1.0}, {});
  }
  std::vector<std::uint64_t> order;
  while (!queue.empty()) {
    const FairQueue::Taken taken = queue.Pop();
    order.push_back(taken.work.ticket);
    queue.Finish(taken.work, 1);
  }
  EXPECT_THAT(order, ElementsAre(1, 2, 3));
}

TEST(FairQueueTest, InteractiveComesBeforeBatchWhichStillMoves) {
  FairQueue queue;
  Push(&queue, Of("batch", 1, WorkClass::kBatch), 100);
  Push(&queue, Of("interactive", 1), 100);
  EXPECT_NEAR(Count(Serve(&queue, 100))["batch"], 10, 1);
}

// Clients that come once and never again, as many as are served: names that
// change, or a crowd.
TEST(FairQueueTest, NewClientsDoNotStarveOneThatWaits) {
  FairQueue queue;
  Push(&queue, Of("old", 1), 100);
  Serve(&queue, 10);
  std::vector<std::string> served;
  for (int k = 0; k < 300; ++k) {
    Push(&queue, Of("new" + std::to_string(2 * k), 1));
    Push(&queue, Of("new" + std::to_string(2 * k + 1), 1));
    served.push_back(Serve(&queue, 1).front());
  }
  // Its share among hundreds who wait, and not nothing.
  EXPECT_GE(Count(served)["old"], 3);
}

TEST(FairQueueTest, OfClientsThatAreGoneHardlyAnyIsKept) {
  FairQueue queue;
  for (int k = 0; k < 10'000; ++k) {
    // Always somebody there.
    Push(&queue, Of(std::to_string(k), 1));
    if (k > 0) Serve(&queue, 1);
    ASSERT_LE(queue.clients(), 10U);
  }
}

TEST(FairQueueTest, ADroppedTaskCostsNobodyAnything) {
  FairQueue queue;
  int ran = 0;
  const auto push = [&](std::uint64_t call) {
    Work work = Of("a", 1, WorkClass::kBatch, call);
    work.call = call;
    queue.Push(work, [&ran](core::TileScratch*) { ++ran; });
  };
  push(1);
  push(2);
  EXPECT_NE(queue.Drop(1), nullptr);
  EXPECT_EQ(queue.Drop(1), nullptr) << "once";
  EXPECT_EQ(queue.Drop(7), nullptr) << "never there";
  EXPECT_EQ(queue.waiting(), 1U);
  const FairQueue::Taken taken = queue.Pop();
  EXPECT_EQ(taken.work.call, 2U);
  EXPECT_EQ(queue.Drop(2), nullptr) << "it is at work";
  queue.Finish(taken.work, 1);
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.clients(), 0U);
  EXPECT_EQ(ran, 0);
}

TEST(FairQueueTest, OpeningComesBeforeBoth) {
  FairQueue queue;
  Push(&queue, Of("a", 1), 100);
  Serve(&queue, 50);
  Push(&queue, Of("b", 1e-4, WorkClass::kOpening), 20);
  EXPECT_EQ(Count(Serve(&queue, 21))["b"], 20);
}

TEST(PriceBookTest, LearnsByMethod) {
  PriceBook prices;
  EXPECT_EQ(prices.Price("A", 2), 2);
  for (int k = 0; k < 200; ++k) prices.Learn("A", 1, 3);
  EXPECT_NEAR(prices.Price("A", 2), 6, 0.01);
  EXPECT_NEAR(prices.Price("A", 0), 3, 0.01);
  // Batch calls do not make the interactive ones look dear.
  EXPECT_EQ(prices.Typical("A"), prices.Typical("B"));
  for (int k = 0; k < 200; ++k) prices.Learn("A", 0.1, 0.3);
  EXPECT_NEAR(prices.Typical("A"), 0.3, 0.01);
  EXPECT_EQ(prices.Price("B", 2), 2);
  // Small calls that are mostly overhead say little about a large one.
  for (int k = 0; k < 3; ++k) prices.Learn("A", 1e-4, 2e-3);
  EXPECT_NEAR(prices.Price("A", 2), 6, 0.1);
  // One strange call does not make a method unusable.
  prices.Learn("A", 1e-9, 100);
  EXPECT_LT(prices.Price("A", 2), 8);
}

}  // namespace
}  // namespace terrane::server
