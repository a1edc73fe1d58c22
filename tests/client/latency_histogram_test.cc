// LatencyHistogram against exact percentiles of the same values.
#include "client/bench/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace terrane::client {
namespace {

using std::chrono::nanoseconds;

constexpr double kRelativeError = 0.002;

double Exact(std::vector<std::int64_t> values, double quantile) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(
      std::max(std::ceil(quantile * static_cast<double>(values.size())), 1.0));
  return static_cast<double>(values[rank - 1]);
}

// Latencies over nine powers of ten.
std::vector<std::int64_t> SomeLatencies(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(0, 9);
  std::vector<std::int64_t> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(static_cast<std::int64_t>(std::pow(10, exponent(random))));
  }
  return values;
}

LatencyHistogram HistogramOf(const std::vector<std::int64_t>& values) {
  LatencyHistogram histogram;
  for (const std::int64_t value : values) histogram.Record(nanoseconds(value));
  return histogram;
}

TEST(LatencyHistogram, PercentilesAreThoseOfTheValues) {
  const std::vector<std::int64_t> values = SomeLatencies(20'000, 1);
  const LatencyHistogram histogram = HistogramOf(values);
  for (const double quantile :
       {0.0, 0.01, 0.1, 0.5, 0.9, 0.99, 0.999, 0.9999, 1.0}) {
    const double exact = Exact(values, quantile);
    EXPECT_NEAR(histogram.ValueAt(quantile), exact, kRelativeError * exact)
        << quantile;
  }
}

TEST(LatencyHistogram, EveryMagnitudeIsWithinTheError) {
  for (int bits = 0; bits < 62; ++bits) {
    for (const std::int64_t value :
         {(std::int64_t{1} << bits), (std::int64_t{1} << bits) * 3 / 2,
          (std::int64_t{1} << (bits + 1)) - 1}) {
      LatencyHistogram histogram;
      histogram.Record(nanoseconds(value));
      histogram.Record(nanoseconds(2 * (value / 2) + 2));
      const auto exact = static_cast<double>(value);
      EXPECT_NEAR(histogram.ValueAt(0.5), exact, kRelativeError * exact + 0.1);
    }
  }
}

TEST(LatencyHistogram, SmallValuesAreExact) {
  LatencyHistogram histogram;
  for (int value = 0; value < 512; ++value) {
    histogram.Record(nanoseconds(value));
  }
  for (int value = 0; value < 512; ++value) {
    EXPECT_EQ(histogram.ValueAt((value + 1) / 512.0), value);
  }
}

TEST(LatencyHistogram, MergedPartsAreTheWhole) {
  const std::vector<std::int64_t> few = SomeLatencies(100, 2);
  const std::vector<std::int64_t> many = SomeLatencies(5'000, 3);
  std::vector<std::int64_t> all = few;
  all.insert(all.end(), many.begin(), many.end());
  const LatencyHistogram whole = HistogramOf(all);
  for (const bool swapped : {false, true}) {
    LatencyHistogram merged = HistogramOf(swapped ? many : few);
    merged.Merge(HistogramOf(swapped ? few : many));
    EXPECT_EQ(merged.count(), whole.count());
    EXPECT_EQ(merged.largest(), whole.largest());
    EXPECT_NEAR(merged.mean_ns(), whole.mean_ns(), 1e-9 * whole.mean_ns());
    for (const double quantile : {0.1, 0.5, 0.99, 0.9999}) {
      EXPECT_EQ(merged.ValueAt(quantile), whole.ValueAt(quantile));
    }
  }
}

TEST(LatencyHistogram, CountMeanAndLargestAreExact) {
  const LatencyHistogram histogram = HistogramOf({1'000, 2'000, 6'000'001});
  EXPECT_EQ(histogram.count(), 3);
  EXPECT_EQ(histogram.largest(), nanoseconds(6'000'001));
  EXPECT_DOUBLE_EQ(histogram.mean_ns(), 6'003'001.0 / 3);
  EXPECT_LE(histogram.ValueAt(1), 6'000'001);
}

TEST(LatencyHistogram, EmptyShowsZero) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0);
  EXPECT_EQ(histogram.ValueAt(0.99), 0);
  EXPECT_EQ(histogram.mean_ns(), 0);
}

TEST(LatencyHistogram, NegativeLatencyCountsAsNone) {
  const LatencyHistogram histogram = HistogramOf({-5});
  EXPECT_EQ(histogram.count(), 1);
  EXPECT_EQ(histogram.ValueAt(1), 0);
}

}  // namespace
}  // namespace terrane::client
