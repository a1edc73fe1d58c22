// How long a client waits between two tries.
#include "client/patience.h"

#include <gtest/gtest.h>

#include <thread>

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

TEST(WaitBeforeNextTry, DoublesUpToTwoSeconds) {
  const int middles_ms[] = {100, 200, 400, 800, 1600, 2000, 2000};
  for (int failures = 1; failures <= 7; ++failures) {
    EXPECT_EQ(WaitBeforeNextTry(failures, {}, 0.5),
              milliseconds(middles_ms[failures - 1]));
  }
  EXPECT_EQ(WaitBeforeNextTry(1'000'000, {}, 0.5), milliseconds(2000));
}

TEST(WaitBeforeNextTry, IsSpreadByHalfOfItEitherWay) {
  EXPECT_EQ(WaitBeforeNextTry(3, {}, 0), milliseconds(200));
  EXPECT_EQ(WaitBeforeNextTry(3, {}, 0.25), milliseconds(300));
  EXPECT_EQ(WaitBeforeNextTry(3, {}, 0.999'999), milliseconds(599));
}

TEST(WaitBeforeNextTry, WhatTheServerAsksForComesOnTop) {
  for (const int asked_ms : {0, 1, 700, 5'000, 30'000}) {
    EXPECT_EQ(WaitBeforeNextTry(1, milliseconds(asked_ms), 0),
              milliseconds(asked_ms + 50));
  }
}

TEST(WaitBeforeNextTry, NobodyIsWaitedForLongerThanThirtySeconds) {
  EXPECT_EQ(WaitBeforeNextTry(1, milliseconds(3'600'000), 0),
            milliseconds(30'050));
}

TEST(SleepFor, SleepsUntilItIsTimeOrAskedToStop) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(SleepFor(milliseconds(30), {}));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(30));
  std::stop_source source;
  std::jthread interrupt([&] { source.request_stop(); });
  EXPECT_FALSE(SleepFor(std::chrono::hours(1), source.get_token()));
}

}  // namespace
}  // namespace terrane::client
