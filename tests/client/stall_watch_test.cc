// Which waits are called too long.
#include "client/stall_watch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

TEST(StallWatch, EndsAWaitThatTakesTooLong) {
  std::promise<void> stalled;
  const auto begin = std::chrono::steady_clock::now();
  StallWatch watch(milliseconds(100), [&] { stalled.set_value(); });
  EXPECT_FALSE(watch.stalled());
  watch.During([&] { return stalled.get_future().wait(), 0; });
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(100));
  EXPECT_TRUE(watch.stalled());
}

TEST(StallWatch, LaterWaitsCountFromTheirOwnBeginning) {
  std::promise<void> stalled;
  StallWatch watch(milliseconds(300), [&] { stalled.set_value(); });
  std::this_thread::sleep_for(milliseconds(250));
  const auto begin = std::chrono::steady_clock::now();
  watch.During([&] { return stalled.get_future().wait(), 0; });
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(300));
}

// The limit is far above what a busy machine adds to a wait of nothing.
TEST(StallWatch, TimeBetweenWaitsDoesNotCount) {
  std::atomic<int> calls = 0;
  StallWatch watch(milliseconds(1000), [&] { ++calls; });
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(watch.During([&] { return i; }), i);
    std::this_thread::sleep_for(milliseconds(700));
  }
  EXPECT_EQ(calls, 0);
  EXPECT_FALSE(watch.stalled());
}

TEST(StallWatch, WithoutALimitNothingStalls) {
  std::atomic<int> calls = 0;
  StallWatch watch(milliseconds(0), [&] { ++calls; });
  watch.During([] {
    std::this_thread::sleep_for(milliseconds(50));
    return 0;
  });
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace terrane::client
