#include "core/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/surface/adaline.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/surface_reference.h"

namespace terrane::core {
namespace {

constexpr SurfaceMethod kMethods[] = {
    SurfaceMethod::kProducts, SurfaceMethod::kAlongT,
    SurfaceMethod::kTwoFactors, SurfaceMethod::kTwoTerms};
constexpr SplineBasis kBases[] = {
    SplineBasis::kBezier, SplineBasis::kBSplineUniform,
    SplineBasis::kBSplineClamped, SplineBasis::kBilinear,
    SplineBasis::kBicubicHermite};

// A random surface of any basis and method, weights by several rules.
SurfaceSpec RandomSpec(SurfaceMethod method, std::mt19937* random) {
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(*random);
  };
  const auto pick = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(*random);
  };
  SurfaceSpec spec;
  spec.seed = pick(-1000, 1000);
  spec.method = method;
  const int degree = pick(1, 5);
  spec.net = WavyNet(kBases[pick(0, 4)], degree, degree + pick(1, 6),
                     degree + pick(1, 6));
  spec.network.weights = {{.offset = draw(-1, 1), .random = draw(-3, 3)},
                          {.i = pick(0, spec.net.columns - 1),
                           .offset = draw(-9, 9),
                           .slope_i = draw(-1, 1)}};
  if (method == SurfaceMethod::kProducts) {
    spec.network.weights.push_back({.j = pick(0, spec.net.rows - 1),
                                    .slope_j = draw(-1, 1),
                                    .random = draw(-2, 2)});
  }
  spec.network.desired = draw(-2, 2);
  spec.network.desired_random = draw(-2, 2);
  spec.network_u.weights = {{.offset = draw(-2, 2), .random = draw(-2, 2)},
                            {.j = 0, .slope_j = 1}};
  spec.network_u.desired = draw(-2, 2);
  spec.network_u.desired_random = draw(-1, 1);
  spec.direction = {draw(-1, 1), draw(-1, 1), draw(-1, 1)};
  return spec;
}

TEST(SurfaceTest, AgreesWithExplicitLmsSteps) {
  std::mt19937 random(5);
  double largest = 0;
  for (const SurfaceMethod method : kMethods) {
    for (const int steps : {1, 2, 10, 1000}) {
      for (int round = 0; round < 20; ++round) {
        SurfaceSpec spec = RandomSpec(method, &random);
        const double rate =
            std::uniform_real_distribution<double>(0.001, 0.99)(random);
        spec.training = Training{rate, steps};
        const SurfaceGrid grid = {37, 23};
        const auto surface = Surface::Create(spec);
        ASSERT_TRUE(surface.ok()) << surface.status();
        const std::vector<float> positions =
            PositionsOf(**surface, {grid, {0, 0, 37, 23}});
        for (std::int64_t k = 0; k < 37 * 23; k += 41) {
          const ReferenceSample expected =
              ReferenceAt(spec, grid, k % 37, k / 37, steps, rate);
          const float* const got =
              positions.data() + 3 * static_cast<std::size_t>(k);
          const double off =
              std::max({std::fabs(got[0] - expected.position.x),
                        std::fabs(got[1] - expected.position.y),
                        std::fabs(got[2] - expected.position.z)});
          largest = std::max(largest, off / expected.scale);
        }
      }
    }
  }
  EXPECT_LE(largest, 1e-5);
  RecordProperty("difference_times_1e9", static_cast<int>(1e9 * largest));
}

TEST(SurfaceTest, TrainingToConvergenceIsTheLimitOfLms) {
  std::mt19937 random(6);
  for (const SurfaceMethod method : kMethods) {
    SurfaceSpec spec = RandomSpec(method, &random);
    const SurfaceGrid grid = {19, 17};
    const std::vector<float> converged = PositionsOf(
        **Surface::Create(spec), {grid, {0, 0, grid.columns, grid.rows}});
    const SurfaceModel model(spec);
    for (std::int64_t k = 0; k < 19 * 17; k += 23) {
      const ReferenceSample expected =
          ReferenceAt(spec, grid, k % 19, k / 19, 4000, 0.4);
      // The network answers what is desired.
      EXPECT_NEAR(expected.response, model.network.Desired(k % 19, k / 19),
                  1e-9);
      EXPECT_NEAR(converged[3 * static_cast<std::size_t>(k) + 2],
                  expected.position.z, 1e-5 * expected.scale);
    }
  }
}

TEST(SurfaceTest, GainIsTheGeometricSum) {
  for (const double input : {0.05, 0.3, 1.0}) {
    for (const double rate : {1e-6, 0.2, 0.9}) {
      for (const int steps : {0, 1, 2, 3, 10, 1000}) {
        double sum = 0;
        for (int k = 0; k < steps; ++k) {
          sum += 2 * rate * std::pow(1 - 2 * rate * input, k);
        }
        EXPECT_NEAR(TrainingGain(Training{rate, steps}, input), sum,
                    1e-12 * (1 + sum));
      }
    }
    EXPECT_DOUBLE_EQ(TrainingGain(std::nullopt, input), 1 / input);
  }
}

// w = 1 and no training: M is the product of the blending functions.
TEST(SurfaceTest, WithoutTrainingAndWithUnitWeightsItIsTheRegularSurface) {
  for (const SplineBasis basis : kBases) {
    for (const SurfaceMethod method : kMethods) {
      SurfaceSpec spec;
      spec.net = WavyNet(basis, 3, 7, 6);
      spec.method = method;
      // The weights of method 4 add up.
      const double one = method == SurfaceMethod::kTwoTerms ? 0.5 : 1.0;
      spec.network.weights = {{.offset = one}};
      spec.network_u.weights = {{.offset = one}};
      spec.training = Training{0, 0};
      const SurfaceGrid grid = {41, 29};
      const std::vector<float> regular = RegularHeightsOf(spec, grid);
      const std::vector<float> heights = HeightsOf(spec, grid);
      for (std::size_t k = 0; k < heights.size(); ++k) {
        ASSERT_NEAR(heights[k], regular[k], 2e-6 * 5);
      }
    }
  }
}

// A curve by repeated linear interpolation of its control values (de Casteljau;
// for B-splines de Boor, over the knots of `degree`).
double CurveByInterpolation(SplineBasis basis, int degree,
                            const std::vector<double>& control, double t) {
  const int count = static_cast<int>(control.size());
  if (basis == SplineBasis::kBezier) degree = count - 1;
  const auto knot = [&](int index) {
    const double at = index - degree;
    return basis == SplineBasis::kBSplineUniform
               ? at
               : std::clamp(at, 0.0, static_cast<double>(count - degree));
  };
  const double position = t * (count - degree);
  int span = degree;
  while (span < count - 1 && position >= knot(span + 1)) ++span;
  std::vector<double> d(control.begin() + (span - degree),
                        control.begin() + span + 1);
  for (int r = 1; r <= degree; ++r) {
    for (int j = degree; j >= r; --j) {
      const double low = knot(j + span - degree);
      const double high = knot(j + 1 + span - r);
      const double share = (position - low) / (high - low);
      const auto at = static_cast<std::size_t>(j);
      d[at] = (1 - share) * d[at - 1] + share * d[at];
    }
  }
  return d[static_cast<std::size_t>(degree)];
}

TEST(SurfaceTest, TheRegularSurfaceAgreesWithDeCasteljauAndDeBoor) {
  for (const SplineBasis basis :
       {SplineBasis::kBezier, SplineBasis::kBSplineUniform,
        SplineBasis::kBSplineClamped}) {
    for (int degree = 1; degree <= 5; ++degree) {
      SurfaceSpec spec;
      spec.net = WavyNet(basis, degree, 9, 7);
      const SurfaceGrid grid = {33, 21};
      const std::vector<float> heights = RegularHeightsOf(spec, grid);
      for (std::int64_t k = 0; k < 33 * 21; ++k) {
        std::vector<double> along_u;
        for (int j = 0; j < 7; ++j) {
          std::vector<double> row;
          for (int i = 0; i < 9; ++i) row.push_back(spec.net.At(i, j).z);
          along_u.push_back(CurveByInterpolation(basis, degree, row,
                                                 GridParameter(k % 33, 33)));
        }
        // Heights are from 1 to 5.
        ASSERT_NEAR(heights[static_cast<std::size_t>(k)],
                    CurveByInterpolation(basis, degree, along_u,
                                         GridParameter(k / 33, 21)),
                    1e-6);
      }
    }
  }
}

TEST(SurfaceTest, ClampedNetsMeetTheirCorners) {
  for (const SplineBasis basis :
       {SplineBasis::kBezier, SplineBasis::kBSplineClamped,
        SplineBasis::kBilinear, SplineBasis::kBicubicHermite}) {
    SurfaceSpec spec;
    spec.net = WavyNet(basis, 3, 6, 5);
    const std::vector<float> heights = RegularHeightsOf(spec, {11, 9});
    EXPECT_EQ(heights.front(), static_cast<float>(spec.net.At(0, 0).z));
    EXPECT_EQ(heights[10], static_cast<float>(spec.net.At(5, 0).z));
    EXPECT_EQ(heights[11 * 8], static_cast<float>(spec.net.At(0, 4).z));
    EXPECT_EQ(heights.back(), static_cast<float>(spec.net.At(5, 4).z));
  }
}

TEST(SurfaceTest, AnyDirectionPerturbsAlongItOnly) {
  SurfaceSpec spec;
  spec.net = HillNet();
  spec.direction = {3, 0, 4};
  const SurfaceGrid grid = {17, 13};
  const SurfaceRequest all = {grid, {0, 0, 17, 13}};
  const auto surface = *Surface::Create(spec);
  const std::vector<float> fractal = PositionsOf(*surface, all);
  std::vector<float> regular(fractal.size());
  ASSERT_TRUE(surface->GenerateRegular(all, {}, {regular, {}, {}}).ok());
  double moved = 0;
  for (std::size_t k = 0; k < fractal.size(); k += 3) {
    const double dx = fractal[k] - regular[k];
    const double dz = fractal[k + 2] - regular[k + 2];
    EXPECT_NEAR(fractal[k + 1], regular[k + 1], 1e-6);
    EXPECT_NEAR(dx * 0.8, dz * 0.6, 2e-6);
    moved = std::max(moved, std::fabs(dx));
  }
  EXPECT_GT(moved, 0.1);
  // Its length does not matter.
  spec.direction = {0.3e-50, 0, 0.4e-50};
  EXPECT_EQ(PositionsOf(**Surface::Create(spec), all), fractal);
}

TEST(SurfaceTest, NormalsAreUnitVectorsAcrossTheSurface) {
  SurfaceSpec spec;
  spec.net = HillNet();
  const SurfaceRequest all = {{33, 33}, {0, 0, 33, 33}};
  std::vector<float> positions(33 * 33 * 3);
  std::vector<float> normals(33 * 33 * 3);
  std::vector<float> uvs(33 * 33 * 2);
  const auto surface = *Surface::Create(spec);
  ASSERT_TRUE(
      surface->GenerateRegular(all, {}, {positions, normals, uvs}).ok());
  const auto at = [&](const std::vector<float>& column, std::size_t k, int c) {
    return static_cast<double>(column[3 * k + static_cast<std::size_t>(c)]);
  };
  for (std::size_t j = 1; j < 32; ++j) {
    for (std::size_t i = 1; i < 32; ++i) {
      const std::size_t k = j * 33 + i;
      double length = 0, along_t = 0, along_u = 0;
      for (int c = 0; c < 3; ++c) {
        length += at(normals, k, c) * at(normals, k, c);
        along_t += at(normals, k, c) *
                   (at(positions, k + 1, c) - at(positions, k - 1, c));
        along_u += at(normals, k, c) *
                   (at(positions, k + 33, c) - at(positions, k - 33, c));
      }
      EXPECT_NEAR(length, 1, 1e-6);
      EXPECT_NEAR(along_t, 0, 1e-6);
      EXPECT_NEAR(along_u, 0, 1e-6);
      EXPECT_GT(at(normals, k, 2), 0);
      EXPECT_FLOAT_EQ(uvs[2 * k], static_cast<float>(i) / 32);
      EXPECT_FLOAT_EQ(uvs[2 * k + 1], static_cast<float>(j) / 32);
    }
  }
}

TEST(SurfaceTest, ANetOfOnePointHasTheDirectionAsNormal) {
  SurfaceSpec spec;
  spec.net = HillNet();
  for (Point3& point : spec.net.points) point = {1, 2, 3};
  spec.direction = {0, -2, 0};
  std::vector<float> positions(3 * 9);
  std::vector<float> normals(3 * 9);
  ASSERT_TRUE((*Surface::Create(spec))
                  ->GenerateRegular({{3, 3}, {0, 0, 3, 3}}, {},
                                    {positions, normals, {}})
                  .ok());
  for (std::size_t k = 0; k < normals.size(); k += 3) {
    EXPECT_EQ(normals[k], 0);
    EXPECT_EQ(normals[k + 1], -1);
    EXPECT_EQ(normals[k + 2], 0);
  }
}

TEST(SurfaceTest, SamplesBelowTheHoleLevelAreLeftOut) {
  SurfaceSpec spec;
  spec.net = HillNet();
  const SurfaceRequest all = {{33, 33}, {0, 0, 33, 33}};
  const std::vector<float> whole = PositionsOf(**Surface::Create(spec), all);
  spec.hole_level = 0.5;
  const std::vector<float> holed = PositionsOf(**Surface::Create(spec), all);
  int left_out = 0;
  for (std::size_t k = 0; k < whole.size(); k += 3) {
    if (whole[k + 2] < 0.5f) {
      EXPECT_TRUE(std::isnan(holed[k]) && std::isnan(holed[k + 2]));
      ++left_out;
    } else {
      EXPECT_EQ(holed[k + 2], whole[k + 2]);
    }
  }
  EXPECT_GT(left_out, 100);
  EXPECT_LT(left_out, 1000);
}

TEST(SurfaceTest, RequestsOutsideTheGridAreNamed) {
  SurfaceSpec spec;
  spec.net = HillNet();
  const auto surface = *Surface::Create(spec);
  const auto message = [&](const SurfaceRequest& request) {
    return std::string(surface->CheckRequest(request).message());
  };
  EXPECT_TRUE(surface->CheckRequest({{9, 9}, {8, 8, 1, 1}}).ok());
  EXPECT_THAT(message({{1, 9}, {0, 0, 1, 1}}),
              ::testing::HasSubstr("columns: must be in [2, 1048576], got 1"));
  EXPECT_THAT(message({{9, 9}, {-1, 0, 1, 1}}),
              ::testing::HasSubstr("window.x: must be in [0, 8], got -1"));
  EXPECT_THAT(message({{9, 9}, {0, 4, 9, 6}}),
              ::testing::HasSubstr("window.height: must be in [1, 5], got 6"));
}

}  // namespace
}  // namespace terrane::core
