// The tree presets that ship: each grows, and is what its name says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/tree/leaves.h"
#include "core/tree/tree_generator.h"
#include "server/actor/presets.h"
#include "server/convert/tree_convert.h"

namespace terrane::server {
namespace {

core::SegmentBlock Grow(const std::string& name) {
  core::Violations violations;
  const core::TreeSpec spec =
      ReadTreeRecipe(TreePresets().at(name).recipe(), {}, "", &violations);
  EXPECT_TRUE(violations.empty()) << name << ": " << violations.ToStatus();
  constexpr std::size_t kAll = 1 << 20;
  core::TreeGenerator generator(*core::Tree::Create(spec), 0, {kAll, kAll});
  core::SegmentBlock rows;
  EXPECT_TRUE(generator.Next({}, &rows).ok());
  EXPECT_TRUE(generator.Done());
  return rows;
}

double ShareOfFlag(const core::SegmentBlock& rows, std::uint8_t flag) {
  const auto count =
      std::count_if(rows.flags.begin(), rows.flags.end(),
                    [flag](std::uint8_t flags) { return (flags & flag) != 0; });
  return static_cast<double>(count) / static_cast<double>(rows.rows());
}

TEST(TreePresetsTest, ThoseOfThePaperAndSpeciesAreThere) {
  std::vector<std::string> names;
  for (const auto& [name, preset] : TreePresets()) names.push_back(name);
  EXPECT_THAT(names, ::testing::IsSupersetOf(
                         {"tree/plain", "tree/genetic", "tree/all-monopodial",
                          "tree/all-sympodial", "tree/all-left",
                          "tree/all-right", "tree/sparse", "tree/dense",
                          "tree/cantor", "tree/cantor-statistical", "tree/oak",
                          "tree/birch", "tree/spruce", "tree/poplar",
                          "tree/willow", "tree/pine", "tree/acacia"}));
}

TEST(TreePresetsTest, EveryOneGrowsAndTellsOfItself) {
  for (const auto& [name, preset] : TreePresets()) {
    SCOPED_TRACE(name);
    EXPECT_FALSE(preset.title().empty());
    EXPECT_FALSE(preset.description().empty());
    const core::SegmentBlock rows = Grow(name);
    EXPECT_GT(rows.rows(), 50u);
    // A species fits into a stream of a second.
    EXPECT_LT(rows.rows(), 50'000u);
  }
}

TEST(TreePresetsTest, ExtremesAreExtreme) {
  EXPECT_EQ(ShareOfFlag(Grow("tree/all-monopodial"), core::kMonopodialFlag), 1);
  EXPECT_EQ(ShareOfFlag(Grow("tree/all-sympodial"), core::kMonopodialFlag), 0);
  EXPECT_GT(ShareOfFlag(Grow("tree/all-left"), core::kLeftFlag),
            ShareOfFlag(Grow("tree/all-right"), core::kLeftFlag) + 0.2);
  EXPECT_GT(Grow("tree/dense").rows(), 5 * Grow("tree/sparse").rows());
}

TEST(TreePresetsTest, RightIsTheMirrorOfLeft) {
  const core::SegmentBlock left = Grow("tree/all-left");
  const core::SegmentBlock right = Grow("tree/all-right");
  ASSERT_EQ(left.rows(), right.rows());
  // Which of two siblings came first may differ, the branches do not.
  const auto tips = [](const core::SegmentBlock& rows, float side) {
    std::vector<std::pair<long, long>> points;
    for (const core::Float3& end : rows.end) {
      points.emplace_back(std::lround(end.z), std::lround(side * end.x));
    }
    std::sort(points.begin(), points.end());
    return points;
  };
  const auto mirrored = tips(left, -1);
  const auto straight = tips(right, 1);
  std::vector<std::pair<long, long>> common;
  std::set_intersection(mirrored.begin(), mirrored.end(), straight.begin(),
                        straight.end(), std::back_inserter(common));
  // But for those that round to another unit.
  EXPECT_GT(common.size(), mirrored.size() * 95 / 100);
}

TEST(TreePresetsTest, SpeciesHaveLeavesAndStandUpright) {
  for (const char* name :
       {"tree/oak", "tree/birch", "tree/spruce", "tree/poplar", "tree/willow",
        "tree/pine", "tree/acacia"}) {
    SCOPED_TRACE(name);
    const v1::TreePreset& preset = TreePresets().at(name);
    EXPECT_EQ(preset.recipe().dimensions(), 3);
    EXPECT_TRUE(preset.recipe().has_leaves());
    EXPECT_THAT(preset.view().bark_color(),
                ::testing::MatchesRegex("#[0-9a-f]{6}"));
    float lowest = 0;
    float highest = 0;
    for (const core::Float3& end : Grow(name).end) {
      lowest = std::min(lowest, end.z);
      highest = std::max(highest, end.z);
    }
    EXPECT_GT(highest, 5) << "metres";
    EXPECT_GT(lowest, -0.1f * highest);
  }
}

}  // namespace
}  // namespace terrane::server
