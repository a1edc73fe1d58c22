#include "core/terrain/calibration.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/base/violations.h"
#include "core/terrain/displacement.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

template <typename HeightAt>
Raster MakeRaster(std::int64_t width, std::int64_t height, HeightAt height_at) {
  Raster raster;
  raster.width = width;
  raster.height = height;
  for (std::int64_t j = 0; j < height; ++j) {
    for (std::int64_t i = 0; i < width; ++i) {
      raster.values.push_back(static_cast<float>(height_at(i, j)));
    }
  }
  return raster;
}

// A sum of plane waves whose variance falls by 2^(-2H) per octave: the spectrum
// of FBM, aliased as point samples of a rough surface are.
Raster Fbm(double roughness, std::int64_t side) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<double> heights(static_cast<std::size_t>(side * side));
  constexpr int kWaves = 1500;
  constexpr double kOctaves = 9;
  for (int n = 0; n < kWaves; ++n) {
    const double octave = kOctaves * (n + share(random)) / kWaves;
    const double wave_number = 2 * M_PI / 256 * std::exp2(octave);
    const double angle = 2 * M_PI * share(random);
    const double phase = 2 * M_PI * share(random);
    const double amplitude = 10 * std::exp2(-roughness * octave);
    const double kx = wave_number * std::cos(angle);
    const double ky = wave_number * std::sin(angle);
    for (std::int64_t j = 0; j < side; ++j) {
      for (std::int64_t i = 0; i < side; ++i) {
        heights[static_cast<std::size_t>(j * side + i)] +=
            amplitude * std::cos(kx * static_cast<double>(i) +
                                 ky * static_cast<double>(j) + phase);
      }
    }
  }
  return MakeRaster(side, side, [&](std::int64_t i, std::int64_t j) {
    return heights[static_cast<std::size_t>(j * side + i)];
  });
}

Raster White(std::int64_t width, std::int64_t height, double left_size,
             double right_size) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, 1);
  return MakeRaster(width, height, [&](std::int64_t i, std::int64_t) {
    return normal(random) * (i < width / 2 ? left_size : right_size);
  });
}

Raster ReadJacksboro() {
  const auto input =
      OIIO::ImageInput::open(TERRANE_TEST_DATA "/jacksboro-3arcsec-4326.tif");
  EXPECT_NE(input, nullptr);
  Raster raster;
  raster.width = input->spec().width;
  raster.height = input->spec().height;
  std::vector<std::int16_t> heights(
      static_cast<std::size_t>(raster.width * raster.height));
  EXPECT_TRUE(
      input->read_image(0, 0, 0, 1, OIIO::TypeDesc::INT16, heights.data()));
  raster.values.assign(heights.begin(), heights.end());
  return raster;
}

double RootMeanSquare(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) {
    sum += static_cast<double>(value) * static_cast<double>(value);
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(CalibrationTest, RecoversTheExponentOfFbm) {
  for (const double roughness : {0.55, 0.75, 0.9}) {
    const auto calibration =
        CalibrateRefinement(Fbm(roughness, 129), std::nullopt);
    ASSERT_TRUE(calibration.ok()) << calibration.status();
    EXPECT_NEAR(calibration->measured_roughness, roughness, 0.08);
    EXPECT_EQ(calibration->roughness, calibration->measured_roughness);
  }
}

TEST(CalibrationTest, WhiteNoiseHasItsKnownResidual) {
  // The residual of independent values: variance 1 + (sum of squared weights).
  const double weights = (1 + 81 + 81 + 1) / 256.0;
  const auto calibration =
      CalibrateRefinement(White(401, 401, 1, 1), std::nullopt);
  ASSERT_TRUE(calibration.ok());
  EXPECT_NEAR(calibration->residual_rms, std::sqrt(1 + weights * weights),
              0.02);
  EXPECT_NEAR(calibration->measured_roughness, 0, 0.02);
  EXPECT_EQ(calibration->roughness, 0.5);
}

TEST(CalibrationTest, FidelityMakesTheFirstDisplacementsTheResidual) {
  const auto calibration = CalibrateRefinement(White(101, 81, 3, 3), 0.7);
  ASSERT_TRUE(calibration.ok());
  EXPECT_EQ(calibration->roughness, 0.7);
  // Deviation of LINEAR's first centre displacement: sqrt(T) times that of P.
  const double first = std::sqrt(calibration->fidelity) *
                       DisplacementDeviation(FractalSource::kSubdivision, 2,
                                             0.7, 1, HalfStep::kCentre);
  EXPECT_NEAR(first, calibration->residual_rms * std::exp2(-0.7), 1e-9);
}

TEST(CalibrationTest, AmplitudeFollowsTheModelsOwnRoughness) {
  const Raster model = White(200, 120, 1, 6);
  const auto calibration = CalibrateRefinement(model, 0.8);
  ASSERT_TRUE(calibration.ok());
  ASSERT_EQ(calibration->amplitude.size(), model.values.size());
  EXPECT_NEAR(RootMeanSquare(calibration->amplitude), 1, 1e-6);
  double left = 0;
  double right = 0;
  for (std::size_t j = 0; j < 120; ++j) {
    for (std::size_t i = 0; i < 70; ++i) {
      left += static_cast<double>(calibration->amplitude[j * 200 + i]);
      right += static_cast<double>(calibration->amplitude[j * 200 + 199 - i]);
    }
  }
  EXPECT_NEAR(right / left, 6, 0.6);
}

TEST(CalibrationTest, APlaneHasNoDetail) {
  const auto calibration = CalibrateRefinement(
      MakeRaster(40, 30,
                 [](std::int64_t i, std::int64_t j) { return 4 * i - 8 * j; }),
      std::nullopt);
  ASSERT_TRUE(calibration.ok());
  EXPECT_EQ(calibration->residual_rms, 0);
  EXPECT_EQ(calibration->fidelity, 0);
  EXPECT_EQ(calibration->roughness, 0.95);
  EXPECT_THAT(calibration->amplitude, ::testing::Each(0.0f));
}

TEST(CalibrationTest, PostsWithoutDataAreLeftOut) {
  const Raster whole = White(200, 200, 2, 2);
  Raster holed = whole;
  for (std::size_t j = 60; j < 140; ++j) {
    for (std::size_t i = 60; i < 140; ++i) holed.values[j * 200 + i] = kNoData;
  }
  const auto expected = CalibrateRefinement(whole, 0.8);
  const auto calibration = CalibrateRefinement(holed, 0.8);
  ASSERT_TRUE(calibration.ok());
  EXPECT_NEAR(calibration->residual_rms, expected->residual_rms, 0.05);
  for (const float amplitude : calibration->amplitude) {
    ASSERT_GT(amplitude, 0.0f);
    ASSERT_LT(amplitude, 3.0f);
  }
}

void ExpectViolation(const absl::Status& status, const std::string& text) {
  EXPECT_THAT(
      ViolationsOf(status),
      ElementsAre(AllOf(Field(&Violation::field, "macro.parts[0].raster"),
                        Field(&Violation::description, HasSubstr(text)))));
}

TEST(CalibrationTest, SaysWhenThereIsNothingToJudgeFrom) {
  ExpectViolation(CalibrateRefinement(White(7, 20, 1, 1), 0.8).status(),
                  "must have at least 8 x 8 posts to calibrate a refinement, "
                  "got 7 x 20");
  ExpectViolation(
      CalibrateRefinement(White(12, 20, 1, 1), std::nullopt).status(),
      "must have at least 13 x 13 posts");
  EXPECT_TRUE(CalibrateRefinement(White(8, 8, 1, 1), 0.8).ok());
  EXPECT_TRUE(CalibrateRefinement(White(13, 13, 1, 1), std::nullopt).ok());

  Raster empty = White(20, 20, 1, 1);
  std::fill(empty.values.begin(), empty.values.end(), kNoData);
  ExpectViolation(CalibrateRefinement(empty, 0.8).status(), "with data");
}

TEST(CalibrationTest, JacksboroIsSmootherThanFbmAndRidgesAreRougher) {
  const Raster model = ReadJacksboro();
  const auto calibration = CalibrateRefinement(model, std::nullopt);
  ASSERT_TRUE(calibration.ok()) << calibration.status();
  RecordProperty("measured_roughness",
                 std::to_string(calibration->measured_roughness));
  // Models like this one were smoothed: 1.5 uncut.
  EXPECT_NEAR(calibration->measured_roughness, 1.5, 0.1);
  EXPECT_EQ(calibration->roughness, 0.95);
  EXPECT_GT(calibration->residual_rms, 1);
  EXPECT_LT(calibration->residual_rms, 20);
  const auto [least, most] = std::minmax_element(calibration->amplitude.begin(),
                                                 calibration->amplitude.end());
  EXPECT_LT(*least, 0.3f);
  EXPECT_GT(*most, 1.5f);
}

}  // namespace
}  // namespace terrane::core
