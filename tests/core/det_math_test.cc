// The deterministic elementary functions against the C library: within 4 ulp.
#include "core/base/det_math.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

#include "gtest/gtest.h"

namespace terrane::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kDraws = 200'000;

// Doubles between two finite values of the same sign, or their place on a line
// through all doubles otherwise.
std::int64_t UlpsBetween(double a, double b) {
  const auto place = [](double value) {
    const std::int64_t bits = std::bit_cast<std::int64_t>(value);
    return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits : bits;
  };
  return std::abs(place(a) - place(b));
}

template <typename Actual, typename Expected>
void ExpectWithin4Ulp(double low, double high, Actual actual,
                      Expected expected) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> argument(low, high);
  for (int n = 0; n < kDraws; ++n) {
    const double x = argument(random);
    ASSERT_LE(UlpsBetween(actual(x), expected(x)), 4)
        << "at " << x << ": " << actual(x) << " for " << expected(x);
  }
}

TEST(DetMathTest, Exp2) {
  const auto expected = [](double x) { return std::exp2(x); };
  ExpectWithin4Ulp(-1, 1, DetExp2, expected);
  ExpectWithin4Ulp(-1022, 1023.9, DetExp2, expected);
  EXPECT_EQ(DetExp2(0), 1);
  EXPECT_EQ(DetExp2(-3), 0.125);
  EXPECT_EQ(DetExp2(1024), kInfinity);
  EXPECT_EQ(DetExp2(-kInfinity), 0);
  EXPECT_TRUE(std::isnan(DetExp2(kNan)));
}

TEST(DetMathTest, Log2) {
  const auto expected = [](double x) { return std::log2(x); };
  ExpectWithin4Ulp(1e-300, 1e300, DetLog2, expected);
  ExpectWithin4Ulp(0.01, 0.7, DetLog2, expected);
  ExpectWithin4Ulp(1.5, 100, DetLog2, expected);
  ExpectWithin4Ulp(0.7, 1.5, DetLog2, expected);
  EXPECT_EQ(DetLog2(8), 3);
  EXPECT_EQ(DetLog2(1), 0);
  EXPECT_EQ(DetLog2(0), -kInfinity);
  EXPECT_EQ(DetLog2(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(DetLog2(-1)));
}

TEST(DetMathTest, Exp) {
  const auto expected = [](double x) { return std::exp(x); };
  ExpectWithin4Ulp(-1, 1, DetExp, expected);
  ExpectWithin4Ulp(-20, 20, DetExp, expected);
  ExpectWithin4Ulp(-700, 700, DetExp, expected);
  EXPECT_EQ(DetExp(0), 1);
  EXPECT_EQ(DetExp(1000), kInfinity);
}

TEST(DetMathTest, Log) {
  const auto expected = [](double x) { return std::log(x); };
  ExpectWithin4Ulp(1e-300, 1e300, DetLog, expected);
  ExpectWithin4Ulp(0.01, 100, DetLog, expected);
  EXPECT_EQ(DetLog(1), 0);
}

TEST(DetMathTest, Pow) {
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> base(1e-3, 1e6);
  std::uniform_real_distribution<double> exponent(-4, 4);
  for (int n = 0; n < kDraws; ++n) {
    const double x = base(random);
    const double y = exponent(random);
    ASSERT_LE(UlpsBetween(DetPow(x, y), std::pow(x, y)), 4)
        << x << " to the power of " << y << ": " << DetPow(x, y);
  }
  EXPECT_EQ(DetPow(0, 0), 1);
  EXPECT_EQ(DetPow(0, 2), 0);
  EXPECT_EQ(DetPow(7, 0), 1);
  EXPECT_EQ(DetPow(0, -1), kInfinity);
  EXPECT_EQ(DetPow(2, 2000), kInfinity);
  EXPECT_EQ(DetPow(2, -2000), 0);
  EXPECT_EQ(DetPow(kInfinity, 0.5), kInfinity);
  EXPECT_EQ(DetPow(kInfinity, -1), 0);
  EXPECT_TRUE(std::isnan(DetPow(-1, 0.5)));
  EXPECT_TRUE(std::isnan(DetPow(2, kNan)));
}

// Next to its zeros a sine has few digits of its own: 2^-60 is allowed there.
template <typename Actual, typename Expected>
void ExpectSineWithin(double range, Actual actual, Expected expected) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> angle(-range, range);
  for (int n = 0; n < kDraws; ++n) {
    const double x = angle(random);
    if (std::fabs(actual(x) - expected(x)) <= 0x1p-60) continue;
    ASSERT_LE(UlpsBetween(actual(x), expected(x)), 4)
        << "at " << x << ": " << actual(x) << " for " << expected(x);
  }
}

TEST(DetMathTest, SinAndCos) {
  for (const double range : {0.8, 7.0, 1e5}) {
    ExpectSineWithin(range, DetSin, [](double x) { return std::sin(x); });
    ExpectSineWithin(range, DetCos, [](double x) { return std::cos(x); });
  }
  EXPECT_EQ(DetSin(0), 0);
  EXPECT_EQ(DetCos(0), 1);
  for (const double range : {0.8, 7.0, 1e5}) {
    ExpectSineWithin(
        range, [](double x) { return DetSinCos(x).sine; },
        [](double x) { return std::sin(x); });
    ExpectSineWithin(
        range, [](double x) { return DetSinCos(x).cosine; },
        [](double x) { return std::cos(x); });
  }
  EXPECT_EQ(DetSinCos(0).sine, 0);
  EXPECT_EQ(DetSinCos(0).cosine, 1);
  EXPECT_TRUE(std::isnan(DetSinCos(-1.1e5).sine));
  EXPECT_TRUE(std::isnan(DetSinCos(kNan).cosine));
  EXPECT_TRUE(std::isnan(DetSin(1.1e5)));
  EXPECT_TRUE(std::isnan(DetCos(kInfinity)));
  EXPECT_TRUE(std::isnan(DetSin(kNan)));
}

}  // namespace
}  // namespace terrane::core
