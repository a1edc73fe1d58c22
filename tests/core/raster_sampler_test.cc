#include "core/grid/raster_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

struct Posts {
  std::int64_t width;
  std::int64_t height;
  std::vector<float> values;

  float At(std::int64_t i, std::int64_t j) const {
    i = std::clamp(i, std::int64_t{0}, width - 1);
    j = std::clamp(j, std::int64_t{0}, height - 1);
    return values[static_cast<std::size_t>(j * width + i)];
  }
  RasterSampler Sampler(SampleKernel kernel) const {
    return RasterSampler(values, width, height, kernel);
  }
};

Posts RandomPosts(std::int64_t width, std::int64_t height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> heights(-300, 4000);
  Posts posts{width, height, {}};
  for (std::int64_t i = 0; i < width * height; ++i) {
    posts.values.push_back(heights(random));
  }
  return posts;
}

std::vector<double> Positions(double first, double step, int count) {
  std::vector<double> result;
  for (int i = 0; i < count; ++i) result.push_back(first + step * i);
  return result;
}

std::vector<float> SampleAll(const RasterSampler& sampler,
                             const std::vector<double>& u,
                             const std::vector<double>& v) {
  std::vector<float> out(u.size() * v.size());
  sampler.Sample(u, v, out.data(), static_cast<std::ptrdiff_t>(u.size()));
  return out;
}

float SampleOne(const RasterSampler& sampler, double u, double v) {
  return SampleAll(sampler, {u}, {v})[0];
}

// Catmull-Rom from its definition: Hermite with central differences.
double CatmullRom(double p0, double p1, double p2, double p3, double t) {
  const double m1 = (p2 - p0) / 2;
  const double m2 = (p3 - p1) / 2;
  const double t2 = t * t;
  const double t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * p1 + (t3 - 2 * t2 + t) * m1 +
         (-2 * t3 + 3 * t2) * p2 + (t3 - t2) * m2;
}

class RasterSamplerTest : public ::testing::TestWithParam<SampleKernel> {};

INSTANTIATE_TEST_SUITE_P(Kernels, RasterSamplerTest,
                         ::testing::Values(SampleKernel::kBilinear,
                                           SampleKernel::kCatmullRom,
                                           SampleKernel::kBSpline));

TEST_P(RasterSamplerTest, MeetsThePosts) {
  const Posts posts = RandomPosts(13, 9);
  const std::vector<float> out = SampleAll(
      posts.Sampler(GetParam()), Positions(0, 1, 13), Positions(0, 1, 9));
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (GetParam() == SampleKernel::kBSpline) {
      EXPECT_NEAR(out[i], posts.values[i], 2e-3);
    } else {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(out[i]),
                std::bit_cast<std::uint32_t>(posts.values[i]));
    }
  }
}

TEST_P(RasterSamplerTest, KeepsAConstant) {
  const Posts posts{5, 4, std::vector<float>(20, 517.3f)};
  for (const float value :
       SampleAll(posts.Sampler(GetParam()), Positions(-1, 0.13, 60),
                 Positions(-1, 0.17, 40))) {
    EXPECT_NEAR(value, 517.3f, 1e-4);
  }
}

TEST_P(RasterSamplerTest, IsTheBorderOutside) {
  const Posts posts = RandomPosts(6, 5);
  const RasterSampler sampler = posts.Sampler(GetParam());
  EXPECT_EQ(SampleOne(sampler, -7, 2.3), SampleOne(sampler, 0, 2.3));
  EXPECT_EQ(SampleOne(sampler, 1e300, 2.3), SampleOne(sampler, 5, 2.3));
  EXPECT_EQ(SampleOne(sampler, 1.5, -1e300), SampleOne(sampler, 1.5, 0));
  EXPECT_EQ(SampleOne(sampler, 1.5, 90), SampleOne(sampler, 1.5, 4));
}

TEST_P(RasterSamplerTest, AValueDoesNotDependOnTheGridItIsAskedIn) {
  const Posts posts = RandomPosts(11, 17);
  const RasterSampler sampler = posts.Sampler(GetParam());
  const std::vector<double> u = Positions(-0.7, 0.371, 40);
  // Falling, with strides over many rows: every order of rows is the same.
  const std::vector<double> v = Positions(18, -2.613, 9);
  const std::vector<float> all = SampleAll(sampler, u, v);
  for (std::size_t j = 0; j < v.size(); ++j) {
    for (std::size_t i = 0; i < u.size(); ++i) {
      EXPECT_EQ(all[j * u.size() + i], SampleOne(sampler, u[i], v[j]));
    }
  }
}

TEST_P(RasterSamplerTest, BoundsHoldEveryValue) {
  const Posts posts = RandomPosts(90, 70);
  const RasterSampler sampler = posts.Sampler(GetParam());
  for (const double low : {-5.0, 3.2, 31.9, 64.0}) {
    const double high = low + 9.7;
    const RasterSampler::Bounds bounds = sampler.BoundsIn(low, low, high, high);
    const std::vector<double> at = Positions(low, 0.097, 101);
    for (const float value : SampleAll(sampler, at, at)) {
      EXPECT_GE(static_cast<double>(value), bounds.minimum);
      EXPECT_LE(static_cast<double>(value), bounds.maximum);
    }
  }
}

TEST_P(RasterSamplerTest, NoDataWhereTheNearestPostHasNone) {
  Posts posts = RandomPosts(8, 8);
  posts.values[3 * 8 + 4] = kNoData;
  const RasterSampler sampler = posts.Sampler(GetParam());
  for (const double u : Positions(0, 0.125, 57)) {
    for (const double v : Positions(0, 0.125, 57)) {
      const bool nearest_has_none =
          std::floor(u + 0.5) == 4 && std::floor(v + 0.5) == 3;
      EXPECT_EQ(std::isnan(SampleOne(sampler, u, v)), nearest_has_none)
          << u << ", " << v;
    }
  }
}

TEST_P(RasterSamplerTest, ALargeHoleIsNeitherSeenNorFelt) {
  Posts posts{60, 60, std::vector<float>(3600, 20.0f)};
  for (std::size_t j = 0; j < 60; ++j) {
    for (std::size_t i = 25; i < 60; ++i) posts.values[j * 60 + i] = kNoData;
  }
  const RasterSampler sampler = posts.Sampler(GetParam());
  EXPECT_NEAR(SampleOne(sampler, 24.4, 30.2), 20.0f, 1e-4);
  EXPECT_TRUE(std::isnan(SampleOne(sampler, 24.5, 30.2)));
}

TEST(RasterSamplerKernelTest, BilinearByItsFormula) {
  const Posts posts{2, 2, {1, 3, 5, 11}};
  EXPECT_FLOAT_EQ(
      SampleOne(posts.Sampler(SampleKernel::kBilinear), 0.25, 0.5),
      0.5f * (0.75f * 1 + 0.25f * 3) + 0.5f * (0.75f * 5 + 0.25f * 11));
}

TEST(RasterSamplerKernelTest, CatmullRomByItsDefinition) {
  const Posts posts = RandomPosts(9, 7);
  const RasterSampler sampler = posts.Sampler(SampleKernel::kCatmullRom);
  for (const double u : Positions(0, 0.31, 26)) {
    for (const double v : Positions(0, 0.23, 26)) {
      const std::int64_t i = static_cast<std::int64_t>(u);
      const std::int64_t j = static_cast<std::int64_t>(v);
      double rows[4];
      for (std::int64_t k = 0; k < 4; ++k) {
        const std::int64_t row = j + k - 1;
        rows[k] = CatmullRom(posts.At(i - 1, row), posts.At(i, row),
                             posts.At(i + 1, row), posts.At(i + 2, row),
                             u - static_cast<double>(i));
      }
      EXPECT_NEAR(SampleOne(sampler, u, v),
                  CatmullRom(rows[0], rows[1], rows[2], rows[3],
                             v - static_cast<double>(j)),
                  1e-3);
    }
  }
}

TEST(RasterSamplerKernelTest, BSplineHasAContinuousSecondDerivative) {
  const Posts posts = RandomPosts(12, 2);
  const RasterSampler sampler = posts.Sampler(SampleKernel::kBSpline);
  const auto bend = [&](double u) {
    constexpr double kStep = 0.05;
    return (static_cast<double>(SampleOne(sampler, u - kStep, 0.4)) -
            2 * static_cast<double>(SampleOne(sampler, u, 0.4)) +
            static_cast<double>(SampleOne(sampler, u + kStep, 0.4))) /
           (kStep * kStep);
  };
  for (const double knot : {3.0, 5.0, 8.0}) {
    // A cubic's bend is linear between knots: extrapolate from both sides.
    const double below = 2 * bend(knot - 0.1) - bend(knot - 0.2);
    const double above = 2 * bend(knot + 0.1) - bend(knot + 0.2);
    EXPECT_NEAR(below, above, 20) << "bends are of the order of 10^4";
    EXPECT_GT(std::fabs(bend(knot)), 200);
  }
}

}  // namespace
}  // namespace terrane::core
