// Which requests a load test sends, and when they are due.
#include "client/bench/request_mix.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "client/bench/arrivals.h"

namespace terrane::client {
namespace {

using testing::HasSubstr;

constexpr int kRequests = 20'000;

TEST(Mix, IsReadByWeight) {
  const absl::StatusOr<MixWeights> weights =
      ParseMix("tiles=8,profiles=0.5,trees");
  ASSERT_TRUE(weights.ok()) << weights.status();
  EXPECT_EQ(*weights, (MixWeights{8, 0.5, 0, 1, 0}));
}

TEST(Mix, WhatIsNoMixIsNamed) {
  for (const char* text : {"", "tile=1", "tiles=", "tiles=-1", "tiles=1e7",
                           "tiles=nan", "tiles=1x", "tiles=1,,trees=1"}) {
    EXPECT_THAT(std::string(ParseMix(text).status().message()),
                HasSubstr("KIND=WEIGHT"))
        << text;
  }
  EXPECT_THAT(std::string(ParseMix("tiles=0").status().message()),
              HasSubstr("above 0"));
}

TEST(RequestMix, SharesFollowTheWeights) {
  MixOptions options;
  options.weights = {8, 1, 0, 1, 0};
  const RequestMix mix(options);
  std::map<RequestKind, int> counts;
  for (int i = 0; i < kRequests; ++i) ++counts[mix.At(i).kind];
  EXPECT_NEAR(counts[RequestKind::kTiles], 0.8 * kRequests, 0.02 * kRequests);
  EXPECT_NEAR(counts[RequestKind::kProfiles], 0.1 * kRequests,
              0.02 * kRequests);
  EXPECT_NEAR(counts[RequestKind::kTrees], 0.1 * kRequests, 0.02 * kRequests);
  EXPECT_EQ(counts[RequestKind::kSurfaces] + counts[RequestKind::kFlowers], 0);
}

TEST(RequestMix, SameSeedAsksTheSameInAnyOrder) {
  MixOptions options;
  options.weights = {1, 1, 1, 1, 1};
  options.cold_share = 0.5;
  options.clients = 3;
  const RequestMix one(options);
  const RequestMix same(options);
  options.seed = 2;
  const RequestMix other(options);
  int equal = 0;
  for (int i = 999; i >= 0; --i) {
    const PlannedRequest a = one.At(i);
    const PlannedRequest b = same.At(i);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(a.place, b.place);
    EXPECT_EQ(a.client, b.client);
    equal += a.seed == other.At(i).seed ? 1 : 0;
  }
  EXPECT_EQ(equal, 0);
}

TEST(RequestMix, HotRequestsShareSeedsAndColdOnesHaveTheirOwn) {
  MixOptions options;
  options.hot_seeds = 5;
  options.cold_share = 0.25;
  const RequestMix mix(options);
  std::map<std::int64_t, int> uses;
  for (int i = 0; i < kRequests; ++i) ++uses[mix.At(i).seed];
  int hot = 0;
  int cold = 0;
  for (const auto& [seed, count] : uses) (count > 1 ? hot : cold) += 1;
  EXPECT_EQ(hot, 5);
  EXPECT_NEAR(cold, 0.25 * kRequests, 0.02 * kRequests);
}

TEST(RequestMix, ClientsShareEquallyOrOneIsGreedy) {
  MixOptions options;
  options.clients = 4;
  std::map<int, int> equal;
  for (int i = 0; i < kRequests; ++i) ++equal[RequestMix(options).At(i).client];
  options.greedy_share = 0.7;
  std::map<int, int> greedy;
  for (int i = 0; i < kRequests; ++i) {
    ++greedy[RequestMix(options).At(i).client];
  }
  for (int client = 0; client < 4; ++client) {
    EXPECT_NEAR(equal[client], kRequests / 4, 0.02 * kRequests);
    EXPECT_NEAR(greedy[client], kRequests * (client == 0 ? 0.7 : 0.1),
                0.02 * kRequests);
  }
}

TEST(Arrivals, MetronomeKeepsItsBeat) {
  Arrivals arrivals(1000, ArrivalKind::kEven, 1);
  for (int i = 1; i <= 100'000; ++i) EXPECT_EQ(arrivals.Take(), i / 1000.0);
}

TEST(Arrivals, PoissonHasItsRateAndItsBursts) {
  Arrivals arrivals(100, ArrivalKind::kPoisson, 7);
  std::vector<double> gaps;
  double last = 0;
  for (int i = 0; i < kRequests; ++i) {
    const double at = arrivals.Take();
    gaps.push_back(at - last);
    last = at;
  }
  EXPECT_NEAR(kRequests / last, 100, 3);
  // Of exponential gaps the share 1 - 1/e is below the mean.
  const auto below = std::count_if(gaps.begin(), gaps.end(),
                                   [](double gap) { return gap < 0.01; });
  EXPECT_NEAR(static_cast<double>(below) / kRequests, 0.632, 0.02);
}

// The clock stands still for a second: what was due meanwhile starts late, and
// its latency still counts from when it was due.
TEST(Arrivals, StallLosesNoRequestAndNoTime) {
  Arrivals arrivals(100, ArrivalKind::kEven, 1);
  EXPECT_THAT(TakeDue(0.005, 1000, &arrivals).start, testing::IsEmpty());
  EXPECT_THAT(TakeDue(0.01, 1000, &arrivals).start, testing::ElementsAre(0.01));
  const DueRequests late = TakeDue(1.01, 1000, &arrivals);
  ASSERT_EQ(late.start.size(), 100U);
  EXPECT_EQ(late.start.front(), 0.02);
  EXPECT_EQ(late.start.back(), 1.01);
  EXPECT_THAT(late.not_started, testing::IsEmpty());
  EXPECT_EQ(arrivals.next(), 1.02);
}

TEST(Arrivals, WhatHasNoSlotIsCountedAsNotStarted) {
  Arrivals arrivals(100, ArrivalKind::kEven, 1);
  const DueRequests due = TakeDue(0.1, 4, &arrivals);
  EXPECT_THAT(due.start, testing::ElementsAre(0.01, 0.02, 0.03, 0.04));
  EXPECT_EQ(due.not_started.size(), 6U);
  EXPECT_THAT(TakeDue(0.11, 0, &arrivals).start, testing::IsEmpty());
}

}  // namespace
}  // namespace terrane::client
