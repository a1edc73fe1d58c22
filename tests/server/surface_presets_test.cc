// The surface presets that ship: each can be generated as its view says.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/surface/surface.h"
#include "server/actor/presets.h"
#include "server/convert/surface_convert.h"

namespace terrane::server {
namespace {

TEST(SurfacePresetsTest, ThereIsOneForEveryFigureOnTheSameNet) {
  ASSERT_EQ(SurfacePresets().size(), 13u);
  const v1::SurfaceNet& net =
      SurfacePresets().at("surface/fig01").recipe().net();
  EXPECT_EQ(net.columns(), 4);
  EXPECT_EQ(net.rows(), 4);
  for (const auto& [name, preset] : SurfacePresets()) {
    EXPECT_EQ(preset.recipe().net().SerializeAsString(),
              net.SerializeAsString())
        << name;
  }
}

TEST(SurfacePresetsTest, EveryOneCanBeGeneratedAndStaysNearItsNet) {
  for (const auto& [name, preset] : SurfacePresets()) {
    SCOPED_TRACE(name);
    core::Violations violations;
    const core::SurfaceSpec spec =
        ReadSurfaceRecipe(preset.recipe(), "", &violations);
    ASSERT_TRUE(violations.empty()) << violations.ToStatus();
    EXPECT_FALSE(preset.title().empty());
    EXPECT_FALSE(preset.description().empty());
    const core::SurfaceGrid grid = {preset.view().columns(),
                                    preset.view().rows()};
    std::vector<float> heights(
        static_cast<std::size_t>(grid.columns * grid.rows));
    ASSERT_TRUE((*core::Surface::Create(spec))
                    ->GenerateHeights({grid, {0, 0, grid.columns, grid.rows}},
                                      {}, heights)
                    .ok());
    std::size_t left_out = 0;
    for (const float height : heights) {
      if (std::isnan(height)) {
        ++left_out;
      } else {
        EXPECT_LT(std::fabs(height), 150);
      }
    }
    EXPECT_EQ(left_out > 0, preset.recipe().has_hole_level());
    EXPECT_LT(left_out, heights.size() / 2);
  }
}

}  // namespace
}  // namespace terrane::server
