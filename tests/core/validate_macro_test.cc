// Every rule of a macro shape, one case each.
#include <memory>
#include <variant>

#include "tests/core/validate_rule.h"

namespace terrane::core {
namespace {

class MacroRuleTest : public ::testing::TestWithParam<Rule> {};

TEST_P(MacroRuleTest, NamesTheFieldTheRangeAndTheValue) {
  ExpectViolation(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Analytic, MacroRuleTest,
    ::testing::Values(
        Rule{"Base", [](TerrainSpec* s) { s->macro.base = 2e9; }, "macro.base",
             "must be in [-1e+09, 1e+09], got 2e+09"},
        Rule{"NoShape", [](TerrainSpec* s) { AddPart(s, std::monostate{}); },
             "macro.parts[0].shape", "must be one of plane, cone"},
        Rule{"PlaneSlope",
             [](TerrainSpec* s) { AddPart(s, Plane{.slope_x = kInfinity}); },
             "macro.parts[0].plane.slope_x", "got inf"},
        Rule{"PlanePoint",
             [](TerrainSpec* s) {
               AddPart(s, Plane{.point = {0, kNan}});
             },
             "macro.parts[0].plane.point.y", "got nan"},
        Rule{"ConeRadius",
             [](TerrainSpec* s) { AddPart(s, Cone{.height = 1}); },
             "macro.parts[0].cone.radius", "must be in (0, 1e+12], got 0"},
        Rule{"HillSigma",
             [](TerrainSpec* s) { AddPart(s, GaussianHill{.sigma_x = -1}); },
             "macro.parts[0].gaussian_hill.sigma_x", "got -1"},
        Rule{"HillSigmaY",
             [](TerrainSpec* s) {
               AddPart(s, GaussianHill{.sigma_x = 1, .sigma_y = kNan});
             },
             "macro.parts[0].gaussian_hill.sigma_y", "got nan"},
        Rule{"RidgeVertices",
             [](TerrainSpec* s) {
               AddPart(s, Ridge{.crest = {{0, 0}}, .half_width = 1});
             },
             "macro.parts[0].ridge.crest.vertices",
             "must have at least 2 elements, got 1"},
        Rule{"RidgeWidth",
             [](TerrainSpec* s) {
               AddPart(s, Ridge{.crest = {{0, 0}, {1, 1}}});
             },
             "macro.parts[0].ridge.half_width", "got 0"},
        Rule{"BossVertices",
             [](TerrainSpec* s) {
               AddPart(s, Boss{.outline = {{0, 0}, {1, 1}}});
             },
             "macro.parts[0].boss.outline.vertices",
             "must have at least 3 elements, got 2"},
        Rule{"BossVertexNan",
             [](TerrainSpec* s) {
               AddPart(s, Boss{.outline = {{0, 0}, {1, 1}, {kNan, 0}}});
             },
             "macro.parts[0].boss.outline.vertices[2].x", "got nan"},
        Rule{"BossFlank",
             [](TerrainSpec* s) {
               AddPart(s, Boss{.outline = {{0, 0}, {1, 1}, {1, 0}},
                               .flank_width = -1});
             },
             "macro.parts[0].boss.flank_width",
             "must be in [0, 1e+12], got -1"}),
    RuleName);

INSTANTIATE_TEST_SUITE_P(
    Sampled, MacroRuleTest,
    ::testing::Values(
        Rule{"NetColumns", [](TerrainSpec* s) { AddPart(s, FlatNet(65, 4)); },
             "macro.parts[0].control_net.columns",
             "must be in [2, 64], got 65"},
        Rule{"NetHeights",
             [](TerrainSpec* s) {
               ControlNet net = FlatNet(5, 4);
               net.heights.pop_back();
               AddPart(s, net);
             },
             "macro.parts[0].control_net.heights",
             "must have rows * columns = 20 elements, got 19"},
        Rule{"NetHeightNan",
             [](TerrainSpec* s) {
               ControlNet net = FlatNet(5, 4);
               net.heights[7] = kNan;
               AddPart(s, net);
             },
             "macro.parts[0].control_net.heights[7]", "got nan"},
        Rule{"NetDegreeHigh",
             [](TerrainSpec* s) {
               ControlNet net = FlatNet(8, 8);
               net.degree = 6;
               AddPart(s, net);
             },
             "macro.parts[0].control_net.degree", "must be in [1, 5], got 6"},
        Rule{"NetDegreeAgainstPoints",
             [](TerrainSpec* s) { AddPart(s, FlatNet(8, 3)); },
             "macro.parts[0].control_net.degree",
             "must be below the number of control points, 3, got 3"},
        Rule{"NetFlat",
             [](TerrainSpec* s) {
               ControlNet net = FlatNet(4, 4);
               net.maximum.y = net.minimum.y;
               AddPart(s, net);
             },
             "macro.parts[0].control_net.maximum.y",
             "must differ from minimum.y, got 0"},
        Rule{"NetRowsOfALine",
             [](TerrainSpec* s) {
               s->dimensions = 1;
               AddPart(s, FlatNet(4, 2));
             },
             "macro.parts[0].control_net.rows", "must be in [1, 1], got 2"},
        Rule{"NoRaster", [](TerrainSpec* s) { AddPart(s, RasterShape{}); },
             "macro.parts[0].raster.raster_id",
             "must name an uploaded raster, got none"},
        Rule{"ThinRaster",
             [](TerrainSpec* s) { AddPart(s, RasterShape{MakeRaster(1, 5)}); },
             "macro.parts[0].raster", "at least 2 x 2 posts, got 1 x 5"},
        Rule{"ShortRaster",
             [](TerrainSpec* s) {
               auto raster = std::make_shared<Raster>(*MakeRaster(3, 3));
               raster->values.pop_back();
               AddPart(s, RasterShape{raster});
             },
             "macro.parts[0].raster", "must have width * height values, got 8"},
        Rule{"RasterSpacing",
             [](TerrainSpec* s) {
               auto raster = std::make_shared<Raster>(*MakeRaster(3, 3));
               raster->frame.spacing_x = 0;
               AddPart(s, RasterShape{raster});
             },
             "macro.parts[0].raster.frame.spacing_x", "got 0"},
        Rule{"RasterOnALine",
             [](TerrainSpec* s) {
               s->dimensions = 1;
               AddPart(s, RasterShape{MakeRaster(3, 3)});
             },
             "macro.parts[0].raster", "needs a recipe of 2 dimensions, got 1"},
        Rule{"ProfileShort",
             [](TerrainSpec* s) {
               AddPart(s, Profile{.heights = {1}, .step_x = 1});
             },
             "macro.parts[0].profile.heights",
             "must have at least 2 elements, got 1"},
        Rule{"ProfileStep",
             [](TerrainSpec* s) {
               AddPart(s, Profile{.heights = {1, 2}});
             },
             "macro.parts[0].profile.step_x", "must be in (0, 1e+12], got 0"},
        Rule{"ProfileSizes",
             [](TerrainSpec* s) {
               AddPart(s, Profile{.x = {0, 1, 2}, .heights = {1, 2}});
             },
             "macro.parts[0].profile.x",
             "must have as many elements as heights, 2, got 3"},
        Rule{"ProfileOrder",
             [](TerrainSpec* s) {
               AddPart(s, Profile{.x = {0, 1, 1}, .heights = {1, 2, 3}});
             },
             "macro.parts[0].profile.x[2]", "must be above 1"},
        Rule{"ProfileCatmullRom",
             [](TerrainSpec* s) {
               AddPart(s, Profile{.x = {0, 1},
                                  .heights = {1, 2},
                                  .interpolation = Interpolation::kCatmullRom});
             },
             "macro.parts[0].profile.interpolation",
             "CATMULL_ROM needs equally spaced samples"},
        Rule{"ProfileBSpline",
             [](TerrainSpec* s) {
               AddPart(s, Profile{.heights = {1, 2},
                                  .step_x = 1,
                                  .interpolation = Interpolation::kBSpline});
             },
             "macro.parts[0].profile.interpolation",
             "must be BILINEAR or CATMULL_ROM, got BSPLINE"}),
    RuleName);

// A wrong field hides none of the others.
TEST(MacroRules, NoFieldHidesAnother) {
  TerrainSpec spec;
  ControlNet net = FlatNet(65, 0);
  net.degree = 6;
  net.heights = {0, kNan, 0};
  net.minimum = {kNan, 0};
  net.maximum = {1, kInfinity};
  AddPart(&spec, net);
  net = FlatNet(4, 4);
  net.heights = {kNan};
  AddPart(&spec, net);
  AddPart(&spec, Profile{.x = {kNan, 1, 0},
                         .heights = {2e9},
                         .interpolation = Interpolation::kCatmullRom});
  EXPECT_THAT(FieldsOf(spec),
              ::testing::ElementsAre("macro.parts[0].control_net.columns",
                                     "macro.parts[0].control_net.rows",
                                     "macro.parts[0].control_net.degree",
                                     "macro.parts[0].control_net.heights[1]",
                                     "macro.parts[0].control_net.minimum.x",
                                     "macro.parts[0].control_net.maximum.y",
                                     "macro.parts[1].control_net.heights",
                                     "macro.parts[1].control_net.heights[0]",
                                     "macro.parts[2].profile.heights",
                                     "macro.parts[2].profile.heights[0]",
                                     "macro.parts[2].profile.x",
                                     "macro.parts[2].profile.x[0]",
                                     "macro.parts[2].profile.x[2]",
                                     "macro.parts[2].profile.interpolation"));
}

// A list that is too long is looked at no further than the longest may be.
TEST(MacroRules, HeightsBeyondTheLargestNetAreNotLookedAt) {
  TerrainSpec spec;
  ControlNet net = FlatNet(64, 64);
  net.heights.resize(100'000, kNan);
  AddPart(&spec, net);
  EXPECT_THAT(FieldsOf(spec),
              ::testing::ElementsAre("macro.parts[0].control_net.heights"));
}

}  // namespace
}  // namespace terrane::core
