// Refining a real elevation model: its posts stay, the detail between them goes
// on where the model ends, and nothing shows where the posts are.
//
// The model is tests/data/jacksboro-3arcsec-4326.tif, 403 x 344 posts, refined
// three levels (eightfold) where nothing else is said. What was measured is
// recorded as a property of each test, with --gtest_output.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/grid/hillshade.h"
#include "tests/property/terrain_patch.h"

namespace terrane::core {
namespace {

constexpr int kLevel = 3;
constexpr int kFactor = 1 << kLevel;
constexpr double kPostSpacing = 90;  // metres, roughly

std::shared_ptr<const Raster> ReadModel() {
  const auto input =
      OIIO::ImageInput::open(TERRANE_TEST_DATA "/jacksboro-3arcsec-4326.tif");
  if (input == nullptr) return nullptr;
  auto raster = std::make_shared<Raster>();
  raster->width = input->spec().width;
  raster->height = input->spec().height;
  raster->frame = {0, 0, kPostSpacing, -kPostSpacing};
  raster->values.resize(
      static_cast<std::size_t>(raster->width * raster->height));
  const bool read = input->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT,
                                      raster->values.data());
  return read ? raster : nullptr;
}

class Jacksboro : public testing::Test {
 protected:
  void SetUp() override {
    model_ = ReadModel();
    ASSERT_NE(model_, nullptr);
  }

  TerrainSpec Spec() const {
    TerrainSpec spec;
    spec.refinement = Refinement{};
    spec.macro.parts.emplace_back().shape.emplace<RasterShape>().raster =
        model_;
    return spec;
  }

  static Patch Refined(const TerrainSpec& spec, int level = kLevel) {
    const auto terrain = MakeTerrain(spec);
    return HeightPatch(*terrain, level,
                       *terrain->Extent(level, Sampling::kPoint));
  }

  Patch Posts() const {
    return {model_->width, model_->height, model_->values};
  }

  std::shared_ptr<const Raster> model_;
};

// --- The posts --------------------------------------------------------------

TEST_F(Jacksboro, AtZeroFidelityIsTheInterpolatedModel) {
  TerrainSpec spec = Spec();
  spec.fidelity = 0;
  RasterShape& shape = std::get<RasterShape>(spec.macro.parts[0].shape);
  shape.interpolation = Interpolation::kBilinear;
  const Patch refined = Refined(spec);
  for (std::int64_t j = 0; j < refined.height; ++j) {
    const std::int64_t row = std::min(j / kFactor, model_->height - 2);
    const double v = static_cast<double>(j) / kFactor - double(row);
    for (std::int64_t i = 0; i < refined.width; ++i) {
      const std::int64_t column = std::min(i / kFactor, model_->width - 2);
      const double u = static_cast<double>(i) / kFactor - double(column);
      const auto post = [&](std::int64_t di, std::int64_t dj) {
        return static_cast<double>(model_->At(column + di, row + dj));
      };
      const double expected =
          (1 - v) * ((1 - u) * post(0, 0) + u * post(1, 0)) +
          v * ((1 - u) * post(0, 1) + u * post(1, 1));
      ASSERT_NEAR(refined.At(i, j), expected, 1e-4) << i << ", " << j;
    }
  }
  // The default interpolation, against the macro shape alone.
  shape.interpolation = Interpolation::kCatmullRom;
  const auto terrain = MakeTerrain(spec);
  const Window whole = *terrain->Extent(kLevel, Sampling::kPoint);
  EXPECT_EQ(HeightPatch(*terrain, kLevel, whole).values,
            MacroPatch(*terrain, kLevel, whole).values);
}

TEST_F(Jacksboro, KeepsEveryPostToTheBit) {
  const auto terrain = MakeTerrain(Spec());
  for (int level = 1; level <= 4; ++level) {
    const Window whole = *terrain->Extent(level, Sampling::kPoint);
    std::int64_t kept = 0;
    std::int64_t moved_between = 0;
    for (std::int64_t j = 0; j < model_->height; ++j) {
      // The row of the posts alone, so that memory stays small.
      const Patch row =
          HeightPatch(*terrain, level, {0, j << level, whole.width, 1});
      for (std::int64_t i = 0; i < model_->width; ++i) {
        const float height = row.values[static_cast<std::size_t>(i << level)];
        kept += height == model_->At(i, j) ? 1 : 0;
      }
      moved_between += row.values[1] != model_->At(0, j) ? 1 : 0;
    }
    EXPECT_EQ(kept, model_->width * model_->height) << "level " << level;
    EXPECT_GT(moved_between, model_->height / 2) << "level " << level;
  }
}

TEST_F(Jacksboro, DeviatesAsTheRootOfFidelity) {
  TerrainSpec spec = Spec();
  spec.fidelity = 0;
  const Patch interpolated = Refined(spec);
  const auto mean_deviation = [&](double fidelity) {
    spec.fidelity = fidelity;
    const Patch refined = Refined(spec);
    double sum = 0;
    for (std::size_t k = 0; k < refined.values.size(); ++k) {
      sum += std::fabs(static_cast<double>(refined.values[k]) -
                       static_cast<double>(interpolated.values[k]));
    }
    return sum / static_cast<double>(refined.values.size());
  };
  const double one = mean_deviation(100);
  EXPECT_GT(one, 0.1);
  EXPECT_NEAR(mean_deviation(25) / one, 0.5, 1e-3);
  EXPECT_NEAR(mean_deviation(900) / one, 3, 3e-3);
}

// --- Across the post spacing ------------------------------------------------

// H by the variogram, along x and y: half the slope by least squares of its
// logarithm against that of the lag. For the model over lags of 1 to 4 posts,
// for the refined model over 1/8 to 1 post.
struct Slopes {
  double x = 0;
  double y = 0;

  std::string Text() const {
    return std::to_string(x) + " " + std::to_string(y);
  }
};

Slopes SlopesOf(const Patch& patch, const std::vector<int>& lags) {
  Variogram x(lags, 1, 0);
  Variogram y(lags, 0, 1);
  x.Add(patch);
  y.Add(patch);
  return {x.Hurst(), y.Hurst()};
}

TEST_F(Jacksboro, ContinuesTheVariogramThroughThePostSpacing) {
  const Slopes above = SlopesOf(Posts(), {1, 2, 3, 4});
  RecordProperty("model_1_to_4_posts", above.Text());
  const double own = (above.x + above.y) / 2;
  // H set to the model's own, and H as calibrated (the model is smoothed at its
  // finest: 1.5, cut to 0.95).
  for (const std::optional<double> roughness :
       {std::optional<double>(own), std::optional<double>()}) {
    TerrainSpec spec = Spec();
    spec.roughness = roughness;
    const Slopes below = SlopesOf(Refined(spec), {1, 2, 3, 4, 6, 8});
    RecordProperty(roughness ? "own" : "calibrated", below.Text());
    EXPECT_NEAR(below.x, above.x, 0.1);
    EXPECT_NEAR(below.y, above.y, 0.1);
  }
  // The estimator tells detail from none: interpolation alone is smooth.
  TerrainSpec smooth = Spec();
  smooth.fidelity = 0;
  const Slopes none = SlopesOf(Refined(smooth), {1, 2, 3, 4, 6, 8});
  RecordProperty("interpolated", none.Text());
  EXPECT_GT(none.x, above.x + 0.1);
  EXPECT_GT(none.y, above.y + 0.1);
}

// --- No trace of the posts --------------------------------------------------

Patch Shaded(const Patch& heights) {
  Patch shade = {heights.width, heights.height,
                 std::vector<float>(heights.values.size())};
  const double spacing = kPostSpacing / kFactor;
  Hillshade({heights.width, heights.height, heights.values},
            GroundScale(GroundSpacing{spacing, spacing}), Light(), 1,
            shade.values);
  return shade;
}

// How strongly brightness changes along x: squared differences. What posts do
// to a picture is to make it change more at some places than at others; its
// mean brightness knows nothing of them, not even when it is plainly
// interpolated.
Patch Contrast(const Patch& shade) {
  Patch contrast = {shade.width - 1, shade.height, {}};
  for (std::int64_t j = 0; j < shade.height; ++j) {
    for (std::int64_t i = 0; i + 1 < shade.width; ++i) {
      const double d = shade.At(i + 1, j) - shade.At(i, j);
      contrast.values.push_back(static_cast<float>(d * d));
    }
  }
  return contrast;
}

// Power of a row at `cycles` over its first `length` samples.
double Power(const Patch& patch, std::int64_t row, std::int64_t length,
             std::int64_t cycles) {
  double real = 0;
  double imaginary = 0;
  for (std::int64_t i = 0; i < length; ++i) {
    const double angle = 2 * std::numbers::pi *
                         static_cast<double>(cycles * i % length) /
                         static_cast<double>(length);
    real += patch.At(i, row) * std::cos(angle);
    imaginary += patch.At(i, row) * std::sin(angle);
  }
  return real * real + imaginary * imaginary;
}

// Power of the rows at the posts' frequency, over the mean of its neighbours':
// about 1 when posts are like any other samples.
double LineAtThePosts(const Patch& patch) {
  const std::int64_t length = 400 * kFactor;
  double at_posts = 0;
  double beside = 0;
  constexpr std::int64_t kBeside = 8;
  // Rows of every position between the posts, away from the border.
  for (std::int64_t row = 5 * kFactor; row < patch.height - kFactor;
       row += kFactor + 1) {
    at_posts += Power(patch, row, length, length / kFactor);
    for (std::int64_t d = 1; d <= kBeside; ++d) {
      beside += Power(patch, row, length, length / kFactor - d) +
                Power(patch, row, length, length / kFactor + d);
    }
  }
  return at_posts / (beside / (2 * kBeside));
}

double CreasesOf(const Patch& patch) {
  SecondDifferences differences(kFactor);
  differences.Add(patch, 0, 0);
  return differences.LargestOverSmallest();
}

TEST_F(Jacksboro, ShowsNoTraceOfThePostGridInTheHillshade) {
  const Patch refined = Refined(Spec());
  TerrainSpec smooth = Spec();
  smooth.fidelity = 0;
  const Patch interpolated = Refined(smooth);
  const Patch shade = Shaded(refined);
  const Patch control = Shaded(interpolated);
  struct Measure {
    const char* name;
    double refined;
    double interpolated;
  };
  const Measure measures[] = {
      {"creases_heights", CreasesOf(refined), CreasesOf(interpolated)},
      {"creases_hillshade", CreasesOf(shade), CreasesOf(control)},
      {"line_at_the_posts", LineAtThePosts(Contrast(shade)),
       LineAtThePosts(Contrast(control))}};
  for (const Measure& measure : measures) {
    RecordProperty(measure.name, std::to_string(measure.refined) +
                                     ", interpolated " +
                                     std::to_string(measure.interpolated));
    // As even as P_fbm itself (its creases are held to 1.5), where plain
    // interpolation is not.
    EXPECT_LE(measure.refined, 1.5) << measure.name;
    EXPECT_GT(measure.interpolated, 2) << measure.name;
  }
}

}  // namespace
}  // namespace terrane::core
