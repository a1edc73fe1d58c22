// The memory limit of control groups, the resident set, and when it is tight.
#include "server/service/memory_watch.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <vector>

#include "server/actor/control_group.h"
#include "tests/client/temporary_folder.h"

namespace terrane::server {
namespace {

constexpr std::int64_t kMib = std::int64_t{1} << 20;

TEST(ControlGroupTest, EveryHierarchyHasItsGroup) {
  const std::string both =
      "5:cpu,cpuacct:/one\n4:memory:/two/three\n1:name=systemd:/\n0::/four\n";
  EXPECT_EQ(ControlGroupOf(both, "memory"), "two/three");
  EXPECT_EQ(ControlGroupOf(both, "cpuacct"), "one");
  EXPECT_EQ(ControlGroupOf(both, ""), "four");
  EXPECT_EQ(ControlGroupOf(both, "pids"), "");
  EXPECT_EQ(ControlGroupOf("0::/\n", ""), "");
  EXPECT_EQ(ControlGroupOf("no such line\n::\n", ""), "");
}

class MemoryLimitTest : public ::testing::Test {
 protected:
  void Write(const std::string& file, const std::string& limit) {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << limit << "\n";
  }

  const client::TemporaryFolder folder_;
  const std::filesystem::path root_ = folder_.File("cgroup");
};

TEST_F(MemoryLimitTest, NoFilesNoLimit) {
  EXPECT_EQ(MemoryLimitWithin("0::/a\n", root_), std::nullopt);
  EXPECT_EQ(MemoryLimitWithin("", root_), std::nullopt);
}

TEST_F(MemoryLimitTest, TightestOfVersion2OnTheWayUpCounts) {
  Write("a/b/memory.max", "max");
  EXPECT_EQ(MemoryLimitWithin("0::/a/b\n", root_), std::nullopt);
  Write("a/memory.max", "536870912");
  EXPECT_EQ(MemoryLimitWithin("0::/a/b\n", root_), 512 * kMib);
  Write("a/b/memory.max", "1073741824");
  EXPECT_EQ(MemoryLimitWithin("0::/a/b\n", root_), 512 * kMib);
  EXPECT_EQ(MemoryLimitWithin("0::/c\n", root_), std::nullopt);
}

// In a container the hierarchy's root is the container's own group, whatever
// path /proc/self/cgroup names.
TEST_F(MemoryLimitTest, RootOfAContainerCounts) {
  Write("memory.max", "268435456");
  EXPECT_EQ(MemoryLimitWithin("0::/\n", root_), 256 * kMib);
  EXPECT_EQ(MemoryLimitWithin("0::/not/seen/here\n", root_), 256 * kMib);
}

TEST_F(MemoryLimitTest, Version1CountsToo) {
  const std::string groups = "4:memory:/x/y\n0::/\n";
  Write("memory/x/y/memory.limit_in_bytes", "9223372036854771712");
  EXPECT_EQ(MemoryLimitWithin(groups, root_), std::nullopt);
  Write("memory/x/memory.limit_in_bytes", "104857600");
  EXPECT_EQ(MemoryLimitWithin(groups, root_), 100 * kMib);
  Write("memory.max", "52428800");
  EXPECT_EQ(MemoryLimitWithin(groups, root_), 50 * kMib);
}

TEST(ResidentBytesTest, GrowsWithWhatIsWritten) {
  const std::int64_t before = ReadResidentBytes();
  ASSERT_GT(before, kMib);
  const std::vector<char> block(64 << 20, 'x');
  EXPECT_GE(ReadResidentBytes(), before + 60 * kMib);
  EXPECT_EQ(block.back(), 'x');
}

TEST(MemoryWatchTest, TightAboveNineTenthsOfTheLimit) {
  for (const auto& [resident, tight] : {std::pair<std::int64_t, bool>{0, false},
                                        {900, false},
                                        {901, true},
                                        {2000, true}}) {
    MemoryWatch watch(1000, [resident = resident] { return resident; });
    EXPECT_EQ(watch.Tight(), tight) << resident;
    EXPECT_EQ(watch.ResidentBytes(), resident);
  }
}

TEST(MemoryWatchTest, WithoutALimitNeverTight) {
  MemoryWatch watch(std::nullopt, [] { return std::int64_t{1} << 60; });
  EXPECT_FALSE(watch.Tight());
}

TEST(MemoryWatchTest, ReadsAgainAfterAWhileOnly) {
  std::int64_t readings = 0;
  MemoryWatch watch(1000, [&readings] { return ++readings; });
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 10'000; ++i) watch.Tight();
  const auto took = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(readings, 1 + took / std::chrono::milliseconds(5));
  const std::int64_t before = readings;
  std::this_thread::sleep_for(std::chrono::milliseconds(6));
  EXPECT_EQ(watch.ResidentBytes(), before + 1);
}

}  // namespace
}  // namespace terrane::server
