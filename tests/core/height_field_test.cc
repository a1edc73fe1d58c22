#include "core/surface/height_field.h"

#include <cmath>
#include <cstring>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/surface_reference.h"

namespace terrane::core {
namespace {

std::vector<float> Raster(const HeightField& field,
                          const SurfaceRequest& request) {
  std::vector<float> heights(
      static_cast<std::size_t>(request.window.width * request.window.height));
  EXPECT_TRUE(field.Generate(request, {}, heights).ok());
  return heights;
}

HeightField FieldOf(const SurfaceSpec& spec) {
  return *HeightField::Create(*Surface::Create(spec));
}

// Equally spaced columns and rows: x and y grow with t and u.
TEST(HeightFieldTest, OfAnEvenNetHasTheHeightsOfTheMesh) {
  SurfaceSpec spec;
  spec.net = HillNet();
  const SurfaceGrid grid = {65, 33};
  const HeightField field = FieldOf(spec);
  EXPECT_EQ(Raster(field, {grid, {0, 0, 65, 33}}), HeightsOf(spec, grid));
  EXPECT_EQ(field.FrameOf(grid), (Frame{0, 0, 3.0 / 64, 3.0 / 32}));
}

TEST(HeightFieldTest, OfAnUnevenNetLiesOnTheSurface) {
  for (const SplineBasis basis :
       {SplineBasis::kBezier, SplineBasis::kBSplineUniform,
        SplineBasis::kBSplineClamped, SplineBasis::kBilinear,
        SplineBasis::kBicubicHermite}) {
    SurfaceSpec spec;
    spec.net = WavyNet(basis, 3, 6, 5);
    for (Point3& point : spec.net.points) {
      point.x += 0.05 * point.x * point.x;
      // A plane over x and y, so that every basis gives the plane.
      point.z = 2 * point.x - 3 * point.y;
    }
    spec.training = Training{0, 0};
    spec.network.weights = {{.offset = 1}};
    const SurfaceGrid grid = {81, 61};
    const HeightField field = FieldOf(spec);
    const Frame frame = field.FrameOf(grid);
    const std::vector<float> heights = Raster(field, {grid, {0, 0, 81, 61}});
    for (std::int64_t k = 0; k < 81 * 61; ++k) {
      const double x =
          frame.origin_x + frame.spacing_x * static_cast<double>(k % 81);
      const double y =
          frame.origin_y + frame.spacing_y * static_cast<double>(k / 81);
      ASSERT_NEAR(heights[static_cast<std::size_t>(k)], 2 * x - 3 * y, 1e-5);
    }
  }
}

TEST(HeightFieldTest, WindowsEqualTheWhole) {
  SurfaceSpec spec;
  spec.net = HillNet();
  // Most of the grid's columns crowd into a corner of the raster.
  for (Point3& point : spec.net.points) point.x *= point.x * point.x;
  spec.hole_level = 0.2;
  const HeightField field = FieldOf(spec);
  const SurfaceGrid grid = {3000, 300};
  const std::vector<float> whole = Raster(field, {grid, {0, 0, 3000, 300}});
  const Window window = {3, 11, 700, 200};
  const std::vector<float> part = Raster(field, {grid, window});
  std::size_t missing = 0;
  for (std::int64_t j = 0; j < window.height; ++j) {
    const float* const row = part.data() + j * window.width;
    ASSERT_EQ(std::memcmp(row, whole.data() + (window.y + j) * 3000 + window.x,
                          700 * sizeof(float)),
              0);
    for (int i = 0; i < 700; ++i) missing += std::isnan(row[i]) ? 1u : 0u;
  }
  EXPECT_GT(missing, 0u);
}

TEST(HeightFieldTest, ANetThatFoldsOverIsRefused) {
  SurfaceSpec spec;
  spec.net = HillNet();
  for (std::size_t i = 0; i < 4; ++i) spec.net.points[4 + i].y = 2.5;
  const auto field = HeightField::Create(*Surface::Create(spec));
  EXPECT_THAT(std::string(field.status().message()),
              ::testing::HasSubstr("net.points: fold over: y must rise"));
}

}  // namespace
}  // namespace terrane::core
