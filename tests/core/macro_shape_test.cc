#include "core/terrain/macro_shape.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using Shape = decltype(MacroPart::shape);

MacroSpec SpecOf(Shape shape) {
  MacroSpec spec;
  spec.parts.push_back({MacroCombine::kAdd, std::move(shape)});
  return spec;
}

SampleGrid GridOf(const Frame& frame, int level, const Window& window) {
  SampleGrid grid;
  FillSampleGrid(frame, level, window.x, window.y, 1, window.width,
                 window.height, &grid);
  return grid;
}

std::vector<float> Evaluate(const MacroShape& shape, const SampleGrid& grid) {
  std::vector<float> out(grid.x.size() * grid.y.size());
  shape.Evaluate(grid, out.data(), static_cast<std::ptrdiff_t>(grid.x.size()));
  return out;
}

float HeightAt(const MacroSpec& spec, double x, double y, int dimensions = 2) {
  SampleGrid grid;
  grid.u = grid.x = {x};
  grid.v = grid.y = {y};
  return Evaluate(MacroShape(spec, dimensions, Frame{}), grid)[0];
}

std::uint32_t Bits(float value) { return std::bit_cast<std::uint32_t>(value); }

std::shared_ptr<const Raster> RandomRaster(const Frame& frame) {
  auto raster = std::make_shared<Raster>();
  raster->width = 21;
  raster->height = 17;
  raster->frame = frame;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> heights(100, 900);
  for (int i = 0; i < 21 * 17; ++i) raster->values.push_back(heights(random));
  return raster;
}

ControlNet Net(SplineBasis basis) {
  ControlNet net;
  net.basis = basis;
  net.columns = 5;
  net.rows = 4;
  for (int i = 0; i < 20; ++i) net.heights.push_back((i * 7) % 11);
  net.minimum = {0, 0};
  net.maximum = {8, 12};
  return net;
}

// Every kind of part at once, with every way to join.
MacroSpec EveryPart() {
  const std::vector<std::pair<MacroCombine, Shape>> parts{
      {MacroCombine::kAdd, Plane{{1, 1}, 3, 0.25, -0.5}},
      {MacroCombine::kAdd, Cone{{2, 3}, 5, 4}},
      {MacroCombine::kAdd, GaussianHill{{-3, 2}, 1, 0.1, 2}},
      {MacroCombine::kMaximum, Cone{{-4, -4}, 2, 6}},
      {MacroCombine::kMinimum, Cone{{4, 4}, 3, -5}},
      {MacroCombine::kAdd, Ridge{{{-8, -8}, {0, 1}, {8, -2}}, 1.5, 3}},
      {MacroCombine::kAdd, Boss{{{-2, -2}, {3, -2}, {0, 2}}, 0.5, -2}},
      {MacroCombine::kAdd, Net(SplineBasis::kBezier)},
      {MacroCombine::kMaximum, Net(SplineBasis::kBSplineUniform)},
      {MacroCombine::kAdd,
       RasterShape{RandomRaster({-6, 5, 0.6, -0.7}), Interpolation::kBSpline}},
      {MacroCombine::kAdd, Profile{{-3, 0, 4}, {1, 5, 2}}},
  };
  MacroSpec spec;
  spec.base = 0.5;
  for (const auto& [combine, shape] : parts) {
    spec.parts.push_back({combine, shape});
  }
  return spec;
}

TEST(MacroShapeTest, NoPartsIsTheBaseEverywhere) {
  MacroSpec spec;
  spec.base = 7.5;
  EXPECT_EQ(MacroShape(spec, 2, Frame{}).constant(), 7.5f);
  EXPECT_EQ(HeightAt(spec, 3, 4), 7.5f);
  EXPECT_FALSE(MacroShape(SpecOf(Plane{}), 2, Frame{}).constant().has_value());
}

TEST(MacroShapeTest, PlaneRises) {
  const MacroSpec spec = SpecOf(Plane{{10, 20}, 100, 2, -3});
  EXPECT_EQ(HeightAt(spec, 10, 20), 100.0f);
  EXPECT_EQ(HeightAt(spec, 12, 21), 101.0f);
  EXPECT_EQ(HeightAt(spec, 12, 21, 1), 104.0f);
}

TEST(MacroShapeTest, ConeFallsToItsRadius) {
  const MacroSpec spec = SpecOf(Cone{{1, 2}, 10, 50});
  EXPECT_EQ(HeightAt(spec, 1, 2), 50.0f);
  EXPECT_EQ(HeightAt(spec, 4, 6), 25.0f);
  EXPECT_EQ(HeightAt(spec, 11, 2), 0.0f);
  EXPECT_EQ(HeightAt(spec, 50, 2), 0.0f);
  EXPECT_EQ(HeightAt(spec, 6, 1e6, 1), 25.0f);
}

TEST(MacroShapeTest, GaussianHillByItsFormula) {
  const MacroSpec spec = SpecOf(GaussianHill{{1, 2}, 3, 5, -8});
  EXPECT_FLOAT_EQ(HeightAt(spec, 1, 2), -8);
  EXPECT_FLOAT_EQ(HeightAt(spec, 4, 7), static_cast<float>(-8 * std::exp(-1)));
  EXPECT_EQ(HeightAt(spec, 1 + 12.5 * 3, 2), 0.0f);
  EXPECT_FLOAT_EQ(HeightAt(SpecOf(GaussianHill{{0, 0}, 2, 0, 1}), 0, 2),
                  static_cast<float>(std::exp(-0.5)));
}

TEST(MacroShapeTest, RidgeHasItsCrestAndItsFeet) {
  const MacroSpec spec = SpecOf(Ridge{{{0, 0}, {10, 0}, {10, 10}}, 4, 20});
  EXPECT_EQ(HeightAt(spec, 5, 0), 20.0f);
  EXPECT_EQ(HeightAt(spec, 10, 7), 20.0f);
  EXPECT_EQ(HeightAt(spec, 5, 2), 10.0f);    // s(1/2) = 1/2
  EXPECT_EQ(HeightAt(spec, 5, -3), 3.125f);  // s(1/4) = 5/32
  EXPECT_EQ(HeightAt(spec, 5, 5), 0.0f);
  EXPECT_EQ(HeightAt(spec, 12, 99, 1), 10.0f);
}

TEST(MacroShapeTest, BossIsFlatOnTopAndFallsOverItsFlank) {
  const std::vector<Point2> square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const MacroSpec spec = SpecOf(Boss{square, 2, 6});
  EXPECT_EQ(HeightAt(spec, 5, 5), 6.0f);
  EXPECT_EQ(HeightAt(spec, 11, 5), 3.0f);
  EXPECT_EQ(HeightAt(spec, 12, 5), 0.0f);
  EXPECT_EQ(HeightAt(spec, -0.5, -77, 1), 4.5f);
  const MacroSpec step = SpecOf(Boss{square, 0, 6});
  EXPECT_EQ(HeightAt(step, 9.999, 5), 6.0f);
  EXPECT_EQ(HeightAt(step, 10.001, 5), 0.0f);
}

TEST(MacroShapeTest, ControlNetsMeetTheirCornersAndGoOnFlat) {
  for (const SplineBasis basis :
       {SplineBasis::kBezier, SplineBasis::kBSplineClamped}) {
    const MacroSpec spec = SpecOf(Net(basis));
    EXPECT_EQ(HeightAt(spec, 0, 0), 0.0f);
    EXPECT_EQ(HeightAt(spec, 8, 0), 28 % 11);
    EXPECT_EQ(HeightAt(spec, 8, 12), (19 * 7) % 11);
    EXPECT_EQ(HeightAt(spec, 99, 40), HeightAt(spec, 8, 12));
  }
}

TEST(MacroShapeTest, ADegreeOneNetIsBilinear) {
  ControlNet net;
  net.degree = 1;
  net.columns = net.rows = 2;
  net.heights = {0, 4, 8, 20};
  net.maximum = {1, 1};
  EXPECT_FLOAT_EQ(HeightAt(SpecOf(net), 0.5, 0.25), 0.75f * 2 + 0.25f * 14);
  net.rows = 1;
  net.heights = {0, 4};
  EXPECT_FLOAT_EQ(HeightAt(SpecOf(net), 0.25, 9, 1), 1);
}

TEST(MacroShapeTest, ProfilesGoThroughTheirVertices) {
  const MacroSpec line = SpecOf(Profile{{0, 1, 5}, {10, 20, 0}});
  EXPECT_EQ(HeightAt(line, 1, 0), 20.0f);
  EXPECT_EQ(HeightAt(line, 3, 5), 10.0f);
  EXPECT_EQ(HeightAt(line, -9, 5), 10.0f);
  EXPECT_EQ(HeightAt(line, 9, 5), 0.0f);

  Profile sampled{{}, {0, 1, 4, 9, 16}, 10, 2, Interpolation::kCatmullRom};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(HeightAt(SpecOf(sampled), 10 + 2 * i, 0),
              static_cast<float>(i * i));
  }
  // Catmull-Rom reproduces a parabola away from the ends.
  EXPECT_FLOAT_EQ(HeightAt(SpecOf(sampled), 13, 0), 1.5f * 1.5f);
  sampled.interpolation = Interpolation::kBilinear;
  EXPECT_FLOAT_EQ(HeightAt(SpecOf(sampled), 13, 0), 2.5f);
}

TEST(MacroShapeTest, ARasterOnTheLatticeKeepsItsPostsToTheBit) {
  // Spacing and origin that x = origin + u * spacing does not invert exactly.
  const Frame frame{-98.1234567, 33.3, 1.0 / 1200, -1.0 / 1200};
  const auto raster = RandomRaster(frame);
  for (const Interpolation interpolation :
       {Interpolation::kBilinear, Interpolation::kCatmullRom}) {
    const MacroShape shape(SpecOf(RasterShape{raster, interpolation}), 2,
                           frame);
    const std::vector<float> posts =
        Evaluate(shape, GridOf(frame, 0, {0, 0, 21, 17}));
    const std::vector<float> finer =
        Evaluate(shape, GridOf(frame, 3, {0, 0, 161, 129}));
    for (std::size_t j = 0; j < 17; ++j) {
      for (std::size_t i = 0; i < 21; ++i) {
        const float post = raster->values[j * 21 + i];
        EXPECT_EQ(Bits(posts[j * 21 + i]), Bits(post));
        EXPECT_EQ(Bits(finer[j * 8 * 161 + i * 8]), Bits(post));
      }
    }
  }
}

TEST(MacroShapeTest, ARasterElsewhereIsPlacedByItsFrame) {
  const auto raster = RandomRaster({100, 200, 10, -10});
  const MacroSpec spec = SpecOf(RasterShape{raster, Interpolation::kBilinear});
  EXPECT_EQ(HeightAt(spec, 130, 180), raster->At(3, 2));
  EXPECT_FLOAT_EQ(HeightAt(spec, 135, 180),
                  0.5f * (raster->At(3, 2) + raster->At(4, 2)));
  EXPECT_EQ(HeightAt(spec, 0, 1000), raster->At(0, 0));
}

TEST(MacroShapeTest, PartsJoinInOrder) {
  MacroSpec spec;
  spec.base = 1;
  spec.parts = {{MacroCombine::kAdd, Plane{.height = 4}},
                {MacroCombine::kMaximum, Cone{{0, 0}, 1, 9}},
                {MacroCombine::kMinimum, Plane{.height = 7}},
                {MacroCombine::kMinimum, Cone{{5, 5}, 1, 3}}};
  EXPECT_EQ(HeightAt(spec, 5, 5), 3.0f);  // min(min(5, 7), 3)
  EXPECT_EQ(HeightAt(spec, 0, 0), 0.0f);  // the last cone is 0 here
  spec.parts.pop_back();
  EXPECT_EQ(HeightAt(spec, 0, 0), 7.0f);  // min(max(5, 9), 7)
  EXPECT_EQ(HeightAt(spec, 3, 3), 5.0f);  // max(5, 0)
}

TEST(MacroShapeTest, NoDataWinsOverEveryPart) {
  auto raster = std::make_shared<Raster>(*RandomRaster(Frame{}));
  raster->values[0] = std::numeric_limits<float>::quiet_NaN();
  MacroSpec spec = SpecOf(RasterShape{raster});
  for (const MacroCombine combine :
       {MacroCombine::kAdd, MacroCombine::kMaximum, MacroCombine::kMinimum}) {
    spec.parts.resize(1);
    spec.parts[0].combine = combine;
    EXPECT_TRUE(std::isnan(HeightAt(spec, 0, 0)));
    spec.parts.push_back({combine, Plane{.height = 3}});
    EXPECT_TRUE(std::isnan(HeightAt(spec, 0, 0)));
    EXPECT_FALSE(std::isnan(HeightAt(spec, 3, 3)));
  }
}

TEST(MacroShapeTest, ATileIsACutOfTheWholeToTheBit) {
  const MacroShape shape(EveryPart(), 2, Frame{0.3, 0.7, 1.1, -0.9});
  const Frame frame{0.3, 0.7, 1.1, -0.9};
  const Window whole{-60, -50, 150, 130};
  const std::vector<float> all = Evaluate(shape, GridOf(frame, 3, whole));
  std::mt19937 random(2);
  for (int n = 0; n < 60; ++n) {
    const std::int64_t i = static_cast<std::int64_t>(random() % 140);
    const std::int64_t j = static_cast<std::int64_t>(random() % 120);
    const std::int64_t columns =
        1 + static_cast<std::int64_t>(random()) % (150 - i);
    const std::int64_t rows =
        1 + static_cast<std::int64_t>(random()) % (130 - j);
    const std::vector<float> tile = Evaluate(
        shape, GridOf(frame, 3, {whole.x + i, whole.y + j, columns, rows}));
    for (std::int64_t y = 0; y < rows; ++y) {
      for (std::int64_t x = 0; x < columns; ++x) {
        ASSERT_EQ(Bits(tile[static_cast<std::size_t>(y * columns + x)]),
                  Bits(all[static_cast<std::size_t>((j + y) * 150 + i + x)]));
      }
    }
  }
}

TEST(MacroShapeTest, ACoarseSampleIsTheFinerOneAtTheSamePlace) {
  const Frame frame{0.3, 0.7, 1.1, -0.9};
  const MacroShape shape(EveryPart(), 2, frame);
  const std::vector<float> coarse =
      Evaluate(shape, GridOf(frame, 2, {-20, -20, 40, 40}));
  const std::vector<float> fine =
      Evaluate(shape, GridOf(frame, 3, {-40, -40, 80, 80}));
  for (std::size_t j = 0; j < 40; ++j) {
    for (std::size_t i = 0; i < 40; ++i) {
      EXPECT_EQ(Bits(coarse[j * 40 + i]), Bits(fine[2 * j * 80 + 2 * i]));
    }
  }
}

TEST(MacroShapeTest, RowsKeepTheirStride) {
  const MacroShape shape(SpecOf(Plane{{0, 0}, 0, 1, 10}), 2, Frame{});
  const SampleGrid grid = GridOf(Frame{}, 0, {0, 0, 2, 2});
  std::vector<float> out(6, -1.0f);
  shape.Evaluate(grid, out.data(), 3);
  EXPECT_THAT(out, ::testing::ElementsAre(0, 1, -1, 10, 11, -1));
}

TEST(MacroShapeTest, BoundsHoldEveryHeight) {
  const Frame frame{0.3, 0.7, 1.1, -0.9};
  const MacroSpec every = EveryPart();
  for (std::size_t parts = 0; parts <= every.parts.size(); ++parts) {
    MacroSpec spec = every;
    spec.parts.resize(parts);
    const MacroShape shape(spec, 2, frame);
    for (const std::int64_t first : {-60, -10, 30}) {
      const SampleGrid grid = GridOf(frame, 3, {first, first, 40, 40});
      const MacroShape::Bounds bounds = shape.BoundsIn(
          grid.x.front(), grid.y.back(), grid.x.back(), grid.y.front());
      for (const float height : Evaluate(shape, grid)) {
        EXPECT_GE(static_cast<double>(height), bounds.minimum);
        EXPECT_LE(static_cast<double>(height), bounds.maximum);
      }
    }
  }
}

}  // namespace
}  // namespace terrane::core
