// The presets that ship: every one can be generated and looked at, and each
// figure of the paper shows, in numbers, what the paper says of it.
#include "server/actor/presets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/terrain/terrain.h"
#include "server/actor/limits.h"
#include "server/convert/terrain_convert.h"

namespace terrane::server {
namespace {

using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::Truly;

// No preset names a raster: it would have to be uploaded first.
// A preset brings all that it needs.
class Nothing : public RasterSource, public SpotTableSource {
 public:
  PlacedRaster Find(const std::string&) override { return {}; }
  std::shared_ptr<const SpotTable> FindTable(const std::string&) override {
    return nullptr;
  }
};

// Says whether a world point belongs to the part of a figure in question.
using Place = std::function<bool(double x, double y)>;

// A preset as its own view shows it.
class Figure {
 public:
  explicit Figure(const std::string& name) {
    const absl::StatusOr<const v1::TerrainPreset*> found = FindPreset(name);
    EXPECT_TRUE(found.ok()) << found.status();
    if (found.ok()) Generate(**found);
  }

  const v1::TerrainPreset& preset() const { return preset_; }
  const std::vector<float>& heights() const { return heights_; }
  const std::vector<float>& macro() const { return macro_; }
  // D - d.
  std::vector<double> Deviations() const {
    std::vector<double> out;
    for (std::size_t i = 0; i < heights_.size(); ++i) {
      out.push_back(double{heights_[i]} - double{macro_[i]});
    }
    return out;
  }

  // The sample nearest to a world point.
  std::size_t At(double x, double y = 0) const {
    const auto column = std::lround((x - grid_.x.front()) / step_x());
    const auto row =
        grid_.y.size() > 1 ? std::lround((y - grid_.y.front()) / step_y()) : 0;
    return static_cast<std::size_t>(row) * grid_.x.size() +
           static_cast<std::size_t>(column);
  }

  double MeanDeviation(const Place& place) const {
    const std::vector<double> deviations = Deviations();
    return Mean(place,
                [&](std::size_t at) { return std::abs(deviations[at]); });
  }

  // Root mean square of the deviation's increments from column to column.
  double Increment(const Place& place) const {
    const std::vector<double> deviations = Deviations();
    return std::sqrt(Mean(place, [&](std::size_t at) {
      return std::pow(deviations[at + 1] - deviations[at], 2);
    }));
  }

  // Share of the samples where D lies below d.
  double ShareBelow(const Place& place) const {
    const std::vector<double> deviations = Deviations();
    return Mean(place,
                [&](std::size_t at) { return deviations[at] < 0 ? 1.0 : 0.0; });
  }

 private:
  void Generate(const v1::TerrainPreset& preset) {
    preset_ = preset;
    Nothing nothing;
    core::Violations violations;
    const ReadRecipe read =
        ReadTerrainRecipe(preset.recipe(), {&nothing, &nothing},
                          Limits().recipe, "recipe.", &violations);
    ASSERT_TRUE(violations.empty()) << violations.ToStatus();
    ASSERT_THAT(read.missing_raster, IsEmpty());
    ASSERT_THAT(read.missing_spot_table, IsEmpty());
    const auto terrain = core::Terrain::Create(read.spec);
    ASSERT_TRUE(terrain.ok()) << terrain.status();

    core::TileRequest request;
    request.level = preset.view().level();
    if (preset.view().has_window()) {
      const v1::Window& window = preset.view().window();
      request.window = {window.x(), window.y(), window.width(),
                        window.height()};
    } else {
      const auto extent =
          (*terrain)->Extent(request.level, core::Sampling::kPoint);
      ASSERT_TRUE(extent.has_value()) << "an endless preset needs a window";
      request.window = *extent;
    }
    const auto count =
        static_cast<std::size_t>(request.window.width * request.window.height);
    heights_.resize(count);
    macro_.resize(count);
    core::TileScratch scratch;
    ASSERT_TRUE((*terrain)->Generate(request, {}, &scratch, heights_).ok());
    ASSERT_TRUE((*terrain)->GenerateMacro(request, &scratch, macro_).ok());
    core::FillSampleGrid(*(*terrain)->spec().frame, request.level,
                         request.window.x, request.window.y, 1,
                         request.window.width, request.window.height, &grid_);
  }

  double step_x() const { return grid_.x[1] - grid_.x[0]; }
  double step_y() const { return grid_.y[1] - grid_.y[0]; }

  // Over the samples of a place, the last column left out.
  double Mean(const Place& place,
              const std::function<double(std::size_t)>& value) const {
    double sum = 0;
    double count = 0;
    for (std::size_t j = 0; j < grid_.y.size(); ++j) {
      for (std::size_t i = 0; i + 1 < grid_.x.size(); ++i) {
        if (!place(grid_.x[i], grid_.y[j])) continue;
        sum += value(j * grid_.x.size() + i);
        ++count;
      }
    }
    EXPECT_GT(count, 0);
    return sum / count;
  }

  v1::TerrainPreset preset_;
  core::SampleGrid grid_;
  std::vector<float> heights_;
  std::vector<float> macro_;
};

Place Everywhere() {
  return [](double, double) { return true; };
}
Place Between(double from, double to) {
  return [=](double x, double) { return from <= x && x <= to; };
}
// By the L1 distance from the middle of the paper's 2-D figures.
Place WithinDiamond(double radius) {
  return [=](double x, double y) {
    return std::abs(x - 8) + std::abs(y - 8) <= radius;
  };
}
Place BeyondDiamond(double radius) {
  return [=](double x, double y) {
    return std::abs(x - 8) + std::abs(y - 8) > radius;
  };
}
Place WithinCircle(double radius) {
  return [=](double x, double y) { return std::hypot(x - 8, y - 8) <= radius; };
}

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const auto& [name, preset] : Presets()) {
    names.push_back(name);
  }
  return names;
}

TEST(PresetsTest, EveryFigureOfThePaperShips) {
  EXPECT_THAT(
      Names(),
      IsSupersetOf({"fbm/fig04a",   "fbm/fig04b", "fbm/fig04c", "fbm/fig04d",
                    "fbm/fig04e",   "fbm/fig05a", "fbm/fig05b", "fbm/fig05c",
                    "fbm/fig05d",   "fbm/fig05e", "fbm/fig06a", "fbm/fig06b",
                    "fbm/fig06c",   "fbm/fig06d", "fbm/fig07a", "fbm/fig07b",
                    "fbm/fig07c",   "fbm/fig07d", "fbm/cloud",  "fbm/waves",
                    "fbm/corrosion"}));
}

class EveryPresetTest : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryPresetTest, IsNamedByItsPathAndGeneratesWithoutGaps) {
  const Figure figure(GetParam());
  EXPECT_EQ(figure.preset().name(), GetParam());
  EXPECT_THAT(figure.preset().title(), Not(IsEmpty()));
  EXPECT_THAT(figure.preset().description(), Not(IsEmpty()));
  EXPECT_THAT(figure.heights(), Not(IsEmpty()));
  EXPECT_THAT(figure.heights(),
              Each(Truly([](float height) { return std::isfinite(height); })));
}

std::string CaseName(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Presets, EveryPresetTest, ::testing::ValuesIn(Names()),
                         CaseName);

TEST(PaperFiguresTest, TheFirstPictureOfEachFigureIsTheMacroShape) {
  for (const char* name :
       {"fbm/fig04a", "fbm/fig05a", "fbm/fig06a", "fbm/fig07a"}) {
    const Figure figure(name);
    EXPECT_EQ(figure.heights(), figure.macro()) << name;
  }
}

TEST(PaperFiguresTest, Figure4cMeetsTheMacroShapeAtItsEightMarks) {
  const Figure b("fbm/fig04b");
  const Figure c("fbm/fig04c");
  EXPECT_EQ(b.heights(), c.heights());
  EXPECT_GT(c.MeanDeviation(Everywhere()), 0.1);
  ASSERT_EQ(c.preset().view().marks_size(), 8);
  ASSERT_EQ(c.preset().recipe().discrete_constraints_size(), 8);
  for (const double x : c.preset().view().marks()) {
    EXPECT_EQ(c.heights()[c.At(x)], c.macro()[c.At(x)]) << "x = " << x;
  }
}

TEST(PaperFiguresTest, Figure4dChangesTheMacroShapeAndKeepsTheDetail) {
  const Figure b("fbm/fig04b");
  const Figure d("fbm/fig04d");
  EXPECT_NE(b.macro(), d.macro());
  const std::vector<double> before = b.Deviations();
  const std::vector<double> after = d.Deviations();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_NEAR(before[i], after[i], 2e-6);
  }
}

TEST(PaperFiguresTest, Figure4eUndulatesLessThanFigure4d) {
  const Figure d("fbm/fig04d");
  const Figure e("fbm/fig04e");
  EXPECT_EQ(d.macro(), e.macro());
  EXPECT_LT(e.Increment(Everywhere()), 0.75 * d.Increment(Everywhere()));
}

// The region of one figure is free ground in the other.
TEST(PaperFiguresTest, Figures5bAnd5cAreSmoothInTheirRegions) {
  const Figure b("fbm/fig05b");
  const Figure c("fbm/fig05c");
  const Place left = Between(1.25, 3.25);
  const Place right = Between(4.75, 6.75);
  EXPECT_LT(b.Increment(left), 0.3 * c.Increment(left));
  EXPECT_LT(b.Increment(left), 0.3 * b.Increment(right));
  EXPECT_LT(c.Increment(right), 0.3 * b.Increment(right));
  EXPECT_LT(c.Increment(right), 0.3 * c.Increment(left));
  // Smooth, but not close to the macro shape.
  EXPECT_GT(b.MeanDeviation(left), 0.3);
  EXPECT_GT(c.MeanDeviation(right), 0.3);
}

// T scales the deviation by sqrt(0.05 / 0.3) and leaves its shape as it is.
TEST(PaperFiguresTest, Figures5dAnd5eAreCloseInTheirRegions) {
  const Figure d("fbm/fig05d");
  const Figure e("fbm/fig05e");
  const Place left = Between(1.25, 3.25);
  const Place right = Between(4.75, 6.75);
  const double ratio = std::sqrt(0.05 / 0.3);
  EXPECT_NEAR(d.MeanDeviation(left) / e.MeanDeviation(left), ratio, 1e-4);
  EXPECT_NEAR(e.MeanDeviation(right) / d.MeanDeviation(right), ratio, 1e-4);
  EXPECT_NEAR(d.Increment(left) / e.Increment(left), ratio, 1e-3);
  EXPECT_NEAR(e.Increment(right) / d.Increment(right), ratio, 1e-3);
}

TEST(PaperFiguresTest, Figure6MeetsTheMacroShapeAtSevenPoints) {
  const Figure b("fbm/fig06b");
  const v1::TerrainRecipe& recipe = b.preset().recipe();
  EXPECT_EQ(recipe.fidelity(), 0.2);
  EXPECT_EQ(recipe.roughness(), 0.8);
  ASSERT_EQ(recipe.discrete_constraints_size(), 7);
  for (const v1::DiscreteConstraint& point : recipe.discrete_constraints()) {
    const std::size_t at = b.At(point.x(), point.y());
    EXPECT_EQ(b.heights()[at], b.macro()[at]) << point.ShortDebugString();
  }
  EXPECT_GT(b.MeanDeviation(Everywhere()), 0.1);
}

TEST(PaperFiguresTest, Figures6cAnd6dFloodTheSameTerrain) {
  const Figure b("fbm/fig06b");
  const auto flooded = [&](const Figure& figure) {
    EXPECT_EQ(figure.heights(), b.heights());
    const double level = figure.preset().view().water_level();
    return std::ranges::count_if(b.heights(),
                                 [&](float height) { return height < level; });
  };
  const auto low = flooded(Figure("fbm/fig06c"));
  const auto high = flooded(Figure("fbm/fig06d"));
  EXPECT_GT(low, 0);
  EXPECT_GT(high, low);
  EXPECT_LT(high, std::ssize(b.heights()));
}

TEST(PaperFiguresTest, Figure7bHasASmoothAndFaithfulPeak) {
  const Figure b("fbm/fig07b");
  EXPECT_LT(b.MeanDeviation(WithinDiamond(3)),
            0.6 * b.MeanDeviation(BeyondDiamond(6)));
  EXPECT_LT(b.Increment(WithinDiamond(3)), 0.3 * b.Increment(BeyondDiamond(6)));
}

TEST(PaperFiguresTest, Figure7dCorrodesTheTopThat7cKeeps) {
  const Figure c("fbm/fig07c");
  const Figure d("fbm/fig07d");
  EXPECT_EQ(c.macro(), d.macro());
  const Place top = WithinCircle(4);
  EXPECT_LT(c.Increment(top), 0.5 * d.Increment(top));
  // Pits below the top as it was made: in d alone.
  EXPECT_EQ(c.ShareBelow(top), 0);
  EXPECT_GT(d.ShareBelow(top), 0.02);
}

TEST(DemoTest, SpotsAreMetAndTheRiverFalls) {
  const Figure figure("demo/spots");
  const v1::SpotHeights& spots = figure.preset().recipe().spots();
  ASSERT_EQ(spots.points_size(), 5);
  for (const v1::SpotHeight& point : spots.points()) {
    EXPECT_EQ(figure.heights()[figure.At(point.x(), point.y())],
              static_cast<float>(point.height()))
        << point.ShortDebugString();
  }
  ASSERT_EQ(spots.lines_size(), 1);
  const v1::SpotLine& river = spots.lines(0);
  EXPECT_TRUE(river.only_falls());
  // The first and the last vertex lie outside the view.
  float before = std::numeric_limits<float>::infinity();
  for (int i = 1; i + 1 < river.vertices_size(); ++i) {
    const v1::Point& vertex = river.vertices(i);
    const std::size_t at = figure.At(vertex.x(), vertex.y());
    // Samples stand at every 32 m along the line, not at its vertices.
    EXPECT_NEAR(figure.heights()[at], figure.macro()[at], 5);
    EXPECT_LT(figure.heights()[at], before) << vertex.ShortDebugString();
    before = figure.heights()[at];
  }
}

}  // namespace
}  // namespace terrane::server
