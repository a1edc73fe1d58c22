// The worker pool, the gate and the admission in front of it, the CPU quota and
// the buffer pool.
#include "server/service/worker_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <latch>
#include <set>

#include "server/actor/cpu_quota.h"
#include "server/service/admission.h"
#include "server/service/buffer_pool.h"
#include "server/service/status.h"
#include "server/service/stream_gate.h"
#include "tests/client/temporary_folder.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(WorkerPoolTest, OneThreadRunsTasksInOrder) {
  std::vector<int> order;
  {
    WorkerPool pool(1);
    for (int i = 0; i < 5; ++i) {
      pool.Submit({}, [&order, i](core::TileScratch*) { order.push_back(i); });
    }
  }  // the destructor runs what is queued
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4));
}

TEST(WorkerPoolTest, ThreadsWorkAtTheSameTimeWithTheirOwnScratch) {
  constexpr int kThreads = 4;
  std::latch all_at_work(kThreads);
  std::mutex mutex;
  std::set<core::TileScratch*> scratches;
  {
    WorkerPool pool(kThreads);
    for (int i = 0; i < kThreads; ++i) {
      pool.Submit({}, [&](core::TileScratch* scratch) {
        all_at_work.arrive_and_wait();
        std::lock_guard lock(mutex);
        scratches.insert(scratch);
      });
    }
  }
  EXPECT_EQ(scratches.size(), std::size_t{kThreads});
}

TEST(WorkerPoolTest, TellsWhatThereIsToDo) {
  WorkerPool pool(1);
  std::latch at_work(1);
  std::latch go(1);
  pool.Submit({.client = "a", .seconds = 2, .call = 1},
              [&](core::TileScratch*) {
                at_work.count_down();
                go.wait();
              });
  at_work.wait();
  pool.Submit({.client = "a", .seconds = 3, .call = 2},
              [](core::TileScratch*) {});
  pool.Submit(
      {.work_class = WorkClass::kBatch, .client = "b", .seconds = 7, .call = 3},
      [](core::TileScratch*) {});
  const WorkerPool::Load load = pool.load();
  EXPECT_EQ(load.workers, 1);
  EXPECT_EQ(load.busy, 1);
  EXPECT_EQ(load.interactive_seconds, 5);
  EXPECT_EQ(load.batch_seconds, 7);
  go.count_down();
}

// Enters a gate and keeps what became of it.
class GateTest : public ::testing::Test {
 protected:
  std::optional<StreamGate::Ticket> Enter(const std::string& client, int i) {
    return gate_.Enter({client, [this, i] { started_.push_back(i); },
                        [this, i] { refused_.push_back(i); }});
  }

  StreamGate gate_{1, 3};
  std::vector<int> started_;
  std::vector<int> refused_;
};

TEST_F(GateTest, StreamsOfAClientStartInTurnAndTheRestIsRefused) {
  const auto first = Enter("a", 1);
  const auto second = Enter("a", 2);
  const auto third = Enter("a", 3);
  Enter("a", 4);
  EXPECT_FALSE(Enter("a", 5).has_value());
  EXPECT_THAT(started_, ElementsAre(1));
  gate_.Leave(*second);  // gave up in the line
  gate_.Leave(*first);
  EXPECT_THAT(started_, ElementsAre(1, 3));
  gate_.Leave(*third);
  EXPECT_THAT(started_, ElementsAre(1, 3, 4));
  EXPECT_THAT(refused_, IsEmpty());
}

TEST_F(GateTest, WhoHasFewestOpenComesNext) {
  StreamGate gate(2, 8);
  const auto enter = [&](const std::string& client, int i) {
    return gate.Enter({client, [this, i] { started_.push_back(i); }, [] {}});
  };
  const auto first = enter("greedy", 1);
  enter("greedy", 2);
  enter("greedy", 3);
  enter("polite", 4);
  gate.Leave(*first);
  EXPECT_THAT(started_, ElementsAre(1, 2, 4));
}

TEST_F(GateTest, NobodyTakesEveryPlace) {
  StreamGate gate(4, 8);
  const auto enter = [&](const std::string& client, int i) {
    return gate.Enter({client, [this, i] { started_.push_back(i); }, [] {}});
  };
  const auto first = enter("greedy", 1);
  for (const int i : {2, 3, 4, 5}) enter("greedy", i);
  EXPECT_THAT(started_, ElementsAre(1, 2, 3));
  enter("polite", 6);
  EXPECT_THAT(started_, ElementsAre(1, 2, 3, 6));
  gate.Leave(*first);
  EXPECT_THAT(started_, ElementsAre(1, 2, 3, 6, 4));
}

TEST_F(GateTest, WhoHasMostInAFullLineLosesTheLastOne) {
  Enter("greedy", 1);
  Enter("greedy", 2);
  const auto third = Enter("greedy", 3);
  Enter("greedy", 4);
  EXPECT_TRUE(Enter("polite", 5).has_value());
  EXPECT_THAT(refused_, ElementsAre(4));
  EXPECT_TRUE(Enter("other", 6).has_value());
  EXPECT_THAT(refused_, ElementsAre(4, 3));
  gate_.Leave(*third);  // refused: nothing more happens
  // All alike: the newcomer goes.
  EXPECT_FALSE(Enter("another", 7).has_value());
  EXPECT_THAT(started_, ElementsAre(1));
}

TEST(WorkerPoolTest, ACallThatIsOverLeavesTheQueue) {
  WorkerPool pool(1);
  std::latch at_work(1);
  std::latch go(1);
  pool.Submit({.client = "a", .call = 1}, [&](core::TileScratch*) {
    at_work.count_down();
    go.wait();
  });
  at_work.wait();
  std::atomic<bool> ran = false;
  const auto held = std::make_shared<int>();
  pool.Submit({.client = "a", .seconds = 5, .call = 2},
              [&ran, held](core::TileScratch*) { ran = true; });
  pool.Leave(2);
  EXPECT_EQ(held.use_count(), 1) << "the task is still there";
  EXPECT_EQ(pool.load().interactive_seconds, 0);
  std::latch last(1);
  pool.Submit({.client = "a", .call = 3},
              [&last](core::TileScratch*) { last.count_down(); });
  go.count_down();
  last.wait();
  EXPECT_FALSE(ran);
}

TEST(AdmissionTest, IsByTheExpectedFinish) {
  WorkerPool pool(1);
  Admission admission(&pool, std::chrono::seconds(10));
  std::latch at_work(1);
  std::latch go(1);
  pool.Submit({.client = "a", .seconds = 8, .call = 1},
              [&](core::TileScratch*) {
                at_work.count_down();
                go.wait();
              });
  at_work.wait();
  const auto left = [](double seconds) {
    return std::chrono::duration<double>(seconds);
  };
  // Behind its own eight seconds; others share.
  EXPECT_TRUE(admission.Admit({.client = "a", .seconds = 1}, left(12)).ok());
  EXPECT_TRUE(admission.Admit({.client = "b", .seconds = 1}, left(3)).ok());
  EXPECT_TRUE(admission.Admit({.client = "a", .seconds = 1}, {}).ok());
  const absl::Status refused =
      admission.Admit({.client = "a", .seconds = 1}, left(10)).status();
  EXPECT_TRUE(absl::IsResourceExhausted(refused));
  EXPECT_EQ(RetryDelayOf(refused), std::chrono::milliseconds(1000));
  pool.Submit({.client = "a", .seconds = 3, .call = 2},
              [](core::TileScratch*) {});
  EXPECT_FALSE(admission.Admit({.client = "a", .seconds = 1}, {}).ok());
  EXPECT_EQ(Admission::ClassOf(0.5), WorkClass::kInteractive);
  EXPECT_EQ(Admission::ClassOf(2), WorkClass::kBatch);
  go.count_down();
}

// An admission whose one worker is at work for as long as the object lives, on
// a call of ten seconds of client "a".
struct BusyAdmission {
  BusyAdmission() {
    pool.Submit({.client = "a", .seconds = 10, .call = 1},
                [this](core::TileScratch*) { go.wait(); });
  }
  ~BusyAdmission() { go.count_down(); }
  bool Admits(double work_seconds, double left_seconds) const {
    return admission
        .Admit({.client = "a", .seconds = work_seconds, .call = 2},
               Admission::Seconds(left_seconds))
        .ok();
  }

  std::latch go{1};
  WorkerPool pool{1};
  Admission admission{&pool, std::chrono::seconds(10)};
};

TEST(AdmissionTest, CorrectsItsExpectationByWhatCallsWaited) {
  BusyAdmission busy;
  EXPECT_TRUE(busy.Admits(1, 15));
  for (int k = 0; k < 200; ++k) busy.admission.Learn({1, 10}, 16, false);
  EXPECT_FALSE(busy.Admits(1, 15));  // 1 + 1.5 * 10 within 0.8 * 15
  EXPECT_TRUE(busy.Admits(1, 21));
  // What did not wait says nothing, and one strange call next to nothing.
  for (int k = 0; k < 200; ++k) busy.admission.Learn({1, 1e-3}, 16, false);
  busy.admission.Learn({1, 10}, 1000, false);
  EXPECT_TRUE(busy.Admits(1, 23));
  // One that its deadline ended early, of a slow reader perhaps, was not fast.
  for (int k = 0; k < 200; ++k) busy.admission.Learn({1, 10}, 2, true);
  EXPECT_FALSE(busy.Admits(1, 15));
  for (int k = 0; k < 200; ++k) busy.admission.Learn({1, 10}, 31, true);
  EXPECT_FALSE(busy.Admits(1, 35));
}

TEST(AdmissionTest, BatchCallsWithoutADeadlineTakeTurnsWhateverTheyCost) {
  BusyAdmission busy;
  Work endless = {.work_class = WorkClass::kBatch, .client = "a", .call = 2};
  endless.seconds = 1e6;
  busy.pool.SetBacklog(endless);
  endless.call = 3;
  EXPECT_TRUE(busy.admission.Admit(endless, std::nullopt).ok());
}

TEST(AdmissionTest, AnIdleServerTriesWhatLooksALittleTooDear) {
  WorkerPool pool(1);
  const Admission admission(&pool, std::chrono::seconds(10));
  const Work dear = {.client = "a", .seconds = 2, .call = 1};
  EXPECT_TRUE(admission.Admit(dear, Admission::Seconds(1)).ok());
  EXPECT_FALSE(admission.Admit(dear, Admission::Seconds(0.1)).ok());
  BusyAdmission busy;
  EXPECT_FALSE(busy.Admits(2, 1));
}

class CpuQuotaTest : public ::testing::Test {
 protected:
  CpuQuotaTest() { std::filesystem::create_directories(root_ / "a" / "b"); }

  void Write(const std::string& group, const std::string& quota) {
    std::ofstream(root_ / group / "cpu.max") << quota << "\n";
  }

  const client::TemporaryFolder folder_;
  const std::filesystem::path root_ = folder_.File("cgroup");
};

TEST_F(CpuQuotaTest, TightestQuotaOnTheWayUpCounts) {
  EXPECT_EQ(CpusWithinQuota(8, "0::/a/b\n", root_), 8);
  Write("a/b", "max 100000");
  EXPECT_EQ(CpusWithinQuota(8, "0::/a/b\n", root_), 8);
  Write("a", "250000 100000");
  EXPECT_EQ(CpusWithinQuota(8, "0::/a/b\n", root_), 3);
  EXPECT_EQ(CpusWithinQuota(2, "0::/a/b\n", root_), 2);
  Write("a/b", "50000 100000");
  EXPECT_EQ(CpusWithinQuota(8, "1:cpu:/x\n0::/a/b\n", root_), 1);
  EXPECT_EQ(CpusWithinQuota(8, "", root_), 8);
}

TEST(UsableCpusTest, IsAtLeastOne) { EXPECT_GE(UsableCpus(), 1); }

TEST(BufferPoolTest, GivesBackWhatFits) {
  BufferPool pool(1000);
  EXPECT_THAT(*pool.Take(), IsEmpty());
  auto small = std::make_unique<std::string>(600, 'a');
  const std::string* const address = small.get();
  pool.Give(std::move(small));
  pool.Give(std::make_unique<std::string>(600, 'b'));  // too much: freed
  const auto taken = pool.Take();
  EXPECT_EQ(taken.get(), address);
  EXPECT_EQ(taken->size(), 600U);
  EXPECT_THAT(*pool.Take(), IsEmpty());
}

}  // namespace
}  // namespace terrane::server
