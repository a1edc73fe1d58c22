// The worker pool, the gate in front of it, the CPU quota and the buffer pool.
#include "server/service/worker_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <latch>
#include <set>

#include "server/service/buffer_pool.h"
#include "server/service/cpu_quota.h"
#include "server/service/stream_gate.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(WorkerPoolTest, OneThreadRunsTasksInOrder) {
  std::vector<int> order;
  {
    WorkerPool pool(1);
    for (int i = 0; i < 5; ++i) {
      pool.Submit([&order, i](core::TileScratch*) { order.push_back(i); });
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
      pool.Submit([&](core::TileScratch* scratch) {
        all_at_work.arrive_and_wait();
        std::lock_guard lock(mutex);
        scratches.insert(scratch);
      });
    }
  }
  EXPECT_EQ(scratches.size(), std::size_t{kThreads});
}

TEST(StreamGateTest, StreamsStartInTurnAndTheRestIsRefused) {
  StreamGate gate(1, 2);
  std::vector<int> started;
  const auto enter = [&](int i) {
    return gate.Enter([&started, i] { started.push_back(i); });
  };
  const auto first = enter(1);
  const auto second = enter(2);
  const auto third = enter(3);
  EXPECT_FALSE(enter(4).has_value());
  EXPECT_THAT(started, ElementsAre(1));
  gate.Leave(*second);  // gave up in the line
  gate.Leave(*first);
  EXPECT_THAT(started, ElementsAre(1, 3));
  gate.Leave(*third);
  enter(5);
  EXPECT_THAT(started, ElementsAre(1, 3, 5));
}

class CpuQuotaTest : public ::testing::Test {
 protected:
  CpuQuotaTest() { std::filesystem::create_directories(root_ / "a" / "b"); }
  ~CpuQuotaTest() override { std::filesystem::remove_all(root_); }

  void Write(const std::string& group, const std::string& quota) {
    std::ofstream(root_ / group / "cpu.max") << quota << "\n";
  }

  const std::filesystem::path root_ =
      std::filesystem::path(::testing::TempDir()) / "terrane_cgroup";
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
