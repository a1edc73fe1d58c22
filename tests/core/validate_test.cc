// Every rule of a TerrainSpec, one case each: what is set, the field that is
// named and what is said of it.
#include "core/terrain/validate.h"

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Violation> Validate(const TerrainSpec& spec,
                                const SpecLimits& limits = {}) {
  Violations violations;
  ValidateSpec(spec, limits, "", &violations);
  return violations.kept();
}

std::shared_ptr<const Raster> MakeRaster(std::int64_t width,
                                         std::int64_t height) {
  auto raster = std::make_shared<Raster>();
  raster->width = width;
  raster->height = height;
  raster->frame = {100, 200, 10, -10};
  raster->values.resize(static_cast<std::size_t>(width * height), 1.0f);
  return raster;
}

void AddPart(TerrainSpec* spec, decltype(MacroPart::shape) shape) {
  spec->macro.parts.push_back({MacroCombine::kAdd, std::move(shape)});
}

void MakeRefinement(TerrainSpec* spec) {
  AddPart(spec, RasterShape{MakeRaster(9, 8)});
  spec->refinement = Refinement{};
}

ContinuousConstraint PointConstraint() {
  return {.target = 0.9, .reach = 2, .vertices = {{1, 2}}};
}

ControlNet FlatNet(int columns, int rows) {
  ControlNet net;
  net.columns = columns;
  net.rows = rows;
  net.heights.resize(static_cast<std::size_t>(columns * rows));
  net.maximum = {1, 1};
  return net;
}

// One rule: breaks it, and how the violation reads.
struct Rule {
  std::string name;
  std::function<void(TerrainSpec*)> breaks;
  std::string field;
  std::string description;
};

class ValidateRuleTest : public ::testing::TestWithParam<Rule> {};

TEST_P(ValidateRuleTest, NamesTheFieldTheRangeAndTheValue) {
  TerrainSpec spec;
  GetParam().breaks(&spec);
  EXPECT_THAT(Validate(spec),
              ElementsAre(AllOf(Field(&Violation::field, GetParam().field),
                                Field(&Violation::description,
                                      HasSubstr(GetParam().description)))));
}

std::string RuleName(const ::testing::TestParamInfo<Rule>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Numbers, ValidateRuleTest,
    ::testing::Values(
        Rule{"DimensionsLow", [](TerrainSpec* s) { s->dimensions = 0; },
             "dimensions", "must be in [1, 2], got 0"},
        Rule{"DimensionsHigh", [](TerrainSpec* s) { s->dimensions = 3; },
             "dimensions", "must be in [1, 2], got 3"},
        Rule{"RoughnessHigh", [](TerrainSpec* s) { s->roughness = 1.7; },
             "roughness", "must be in (0, 1), got 1.7"},
        Rule{"RoughnessOpenLow", [](TerrainSpec* s) { s->roughness = 0; },
             "roughness", "must be in (0, 1), got 0"},
        Rule{"RoughnessOpenHigh", [](TerrainSpec* s) { s->roughness = 1; },
             "roughness", "must be in (0, 1), got 1"},
        Rule{"RoughnessNan", [](TerrainSpec* s) { s->roughness = kNan; },
             "roughness", "must be in (0, 1), got nan"},
        Rule{"FidelityNegative", [](TerrainSpec* s) { s->fidelity = -0.5; },
             "fidelity", "must be in [0, 1e+12], got -0.5"},
        Rule{"FidelityInfinite",
             [](TerrainSpec* s) { s->fidelity = kInfinity; }, "fidelity",
             "got inf"},
        Rule{"SigmaZero", [](TerrainSpec* s) { s->sigma = 0; }, "sigma",
             "must be in (0, 1e+06], got 0"},
        Rule{"DeltaHigh", [](TerrainSpec* s) { s->delta = 1.5; }, "delta",
             "must be in (0, 1], got 1.5"},
        Rule{"SoftLimitZero", [](TerrainSpec* s) { s->soft_limit = 0; },
             "soft_limit", "must be in (0, 1e+09], got 0"},
        Rule{"CellsZero",
             [](TerrainSpec* s) {
               s->domain = Domain{0, 4};
             },
             "domain.cells_x", "must be in [1, 1048576], got 0"},
        Rule{"CellsMany",
             [](TerrainSpec* s) {
               s->domain = Domain{4, (1 << 20) + 1};
             },
             "domain.cells_y", "must be in [1, 1048576], got 1048577"},
        Rule{"OriginInfinite",
             [](TerrainSpec* s) {
               s->frame = Frame{-kInfinity, 0, 1, 1};
             },
             "frame.origin_x", "got -inf"},
        Rule{"SpacingZero",
             [](TerrainSpec* s) {
               s->frame = Frame{0, 0, 1, 0};
             },
             "frame.spacing_y", "must be at least 1e-12 in size, got 0"},
        Rule{"SpacingNan",
             [](TerrainSpec* s) {
               s->frame = Frame{0, 0, kNan, 1};
             },
             "frame.spacing_x", "got nan"}),
    RuleName);

INSTANTIATE_TEST_SUITE_P(
    Macro, ValidateRuleTest,
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
    SampledShapes, ValidateRuleTest,
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

INSTANTIATE_TEST_SUITE_P(
    Refinement, ValidateRuleTest,
    ::testing::Values(
        Rule{"Source",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               s->source = FractalSource::kMidpoint;
             },
             "source", "must be SUBDIVISION with a refinement, got MIDPOINT"},
        Rule{"Mapping",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               s->mapping = HeightMapping::kBoltzmann;
             },
             "mapping", "must be LINEAR with a refinement, got BOLTZMANN"},
        Rule{"Base",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               s->macro.base = 1;
             },
             "macro.base", "must be 0 with a refinement, got 1"},
        Rule{"NoParts", [](TerrainSpec* s) { s->refinement.emplace(); },
             "macro.parts", "must be one raster part with a refinement, got 0"},
        Rule{"TwoParts",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               AddPart(s, Plane{});
             },
             "macro.parts", "got 2 parts"},
        Rule{"OtherShape",
             [](TerrainSpec* s) {
               AddPart(s, Plane{});
               s->refinement.emplace();
             },
             "macro.parts", "got 1 part of another shape"},
        Rule{"Combine",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               s->macro.parts[0].combine = MacroCombine::kMaximum;
             },
             "macro.parts[0].combine", "must be ADD with a refinement"},
        Rule{"Interpolation",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               std::get<RasterShape>(s->macro.parts[0].shape).interpolation =
                   Interpolation::kBSpline;
             },
             "macro.parts[0].raster.interpolation",
             "must be BILINEAR or CATMULL_ROM with a refinement, got BSPLINE"},
        Rule{"Domain",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               s->domain = Domain{9, 8};
             },
             "domain", "must be the cells of the refined raster, 8 x 7, got 9"},
        Rule{"Frame",
             [](TerrainSpec* s) {
               MakeRefinement(s);
               s->frame = Frame{};
             },
             "frame", "must be the frame of the refined raster"},
        Rule{"TooLong",
             [](TerrainSpec* s) {
               AddPart(s, RasterShape{MakeRaster((1 << 20) + 2, 2)});
               s->refinement.emplace();
             },
             "macro.parts[0].raster",
             "must have at most 1048577 posts a side"}),
    RuleName);

INSTANTIATE_TEST_SUITE_P(
    Constraints, ValidateRuleTest,
    ::testing::Values(
        Rule{"DiscreteNeedsMidpoint",
             [](TerrainSpec* s) { s->discrete_constraints.emplace_back(); },
             "discrete_constraints", "need source MIDPOINT, got SUBDIVISION"},
        Rule{"DiscreteNan",
             [](TerrainSpec* s) {
               s->source = FractalSource::kMidpoint;
               s->discrete_constraints = {{}, {.point = {kNan, 0}}};
             },
             "discrete_constraints[1].x", "got nan"},
        Rule{"DiscreteOutside",
             [](TerrainSpec* s) {
               s->source = FractalSource::kMidpoint;
               s->domain = Domain{4, 3};
               s->frame = Frame{10, 20, 2, -2};
               s->discrete_constraints = {{.point = {18, 14}},
                                          {.point = {18, 13.5}}};
             },
             "discrete_constraints[1].y", "must be in [14, 20], got 13.5"},
        Rule{"DiscreteLevel",
             [](TerrainSpec* s) {
               s->source = FractalSource::kMidpoint;
               s->discrete_constraints = {{.level = kMaxLevel + 1}};
             },
             "discrete_constraints[0].level", "must be in [0, 40], got 41"},
        Rule{"DiscreteRadius",
             [](TerrainSpec* s) {
               s->source = FractalSource::kMidpoint;
               s->discrete_constraints = {{.radius = 0}};
             },
             "discrete_constraints[0].radius", "must be in (0, 1e+12], got 0"},
        Rule{"DiscreteMany",
             [](TerrainSpec* s) {
               s->source = FractalSource::kMidpoint;
               // Their contents are bad too, and are not looked at.
               s->discrete_constraints.resize(10'001, {.radius = kNan});
             },
             "discrete_constraints", "must have at most 10000 elements"},
        Rule{"RoughnessTarget",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].target = 1;
             },
             "continuous_constraints[0].target", "must be in (0, 1), got 1"},
        Rule{"FidelityTarget",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].quantity =
                   ConstraintQuantity::kFidelity;
               s->continuous_constraints[0].target = -1;
             },
             "continuous_constraints[0].target",
             "must be in [0, 1e+12], got -1"},
        Rule{"Falloff",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].falloff = -1;
             },
             "continuous_constraints[0].falloff",
             "must be in [0, 1e+12], got -1"},
        Rule{"Reach",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].reach = 0;
             },
             "continuous_constraints[0].reach", "must be in (0, 1e+12], got 0"},
        Rule{"NoSource",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].vertices.clear();
             },
             "continuous_constraints[0].source", "got none"},
        Rule{"PointNan",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].vertices[0].y = kNan;
             },
             "continuous_constraints[0].point.y", "got nan"},
        Rule{"PolylineShort",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].kind = SourceKind::kPolyline;
             },
             "continuous_constraints[0].polyline.vertices",
             "must have at least 2 elements, got 1"},
        Rule{"PolygonShort",
             [](TerrainSpec* s) {
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].kind = SourceKind::kPolygon;
               s->continuous_constraints[0].vertices.resize(2);
             },
             "continuous_constraints[0].polygon.vertices",
             "must have at least 3 elements, got 2"},
        Rule{"PolygonOnALine",
             [](TerrainSpec* s) {
               s->dimensions = 1;
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].kind = SourceKind::kPolygon;
               s->continuous_constraints[0].vertices.resize(3);
             },
             "continuous_constraints[0].polygon",
             "must be a point or a polyline in a recipe of 1 dimension"},
        Rule{"LongIntervalOnALine",
             [](TerrainSpec* s) {
               s->dimensions = 1;
               s->continuous_constraints = {PointConstraint()};
               s->continuous_constraints[0].kind = SourceKind::kPolyline;
               s->continuous_constraints[0].vertices.resize(3);
             },
             "continuous_constraints[0].polyline.vertices",
             "must have 2 elements in a recipe of 1 dimension, got 3"}),
    RuleName);

TEST(ValidateSpecTest, AcceptsWhatIsValid) {
  EXPECT_THAT(Validate(TerrainSpec{}), IsEmpty());

  TerrainSpec refined;
  MakeRefinement(&refined);
  refined.domain = Domain{8, 7};
  refined.frame = Frame{100, 200, 10, -10};
  EXPECT_THAT(Validate(refined), IsEmpty());

  TerrainSpec line;
  line.dimensions = 1;
  line.domain = Domain{4, 0};
  line.source = FractalSource::kMidpoint;
  line.discrete_constraints = {{.point = {4, kNan}}};  // y is not used
  AddPart(&line, FlatNet(4, 1));
  AddPart(&line, Profile{.x = {0, 1, 3}, .heights = {1, 2, 1}});
  EXPECT_THAT(Validate(line), IsEmpty());
}

TEST(ValidateSpecTest, TellsEverythingInOnePassInTheOrderOfTheFields) {
  TerrainSpec spec;
  spec.roughness = 2;
  spec.fidelity = -1;
  spec.domain = Domain{0, 0};
  AddPart(&spec, Cone{.radius = -1, .height = kNan});
  spec.continuous_constraints = {{.target = 0, .reach = -1}};

  Violations violations;
  ValidateSpec(spec, SpecLimits{}, "recipe.", &violations);

  std::vector<std::string> fields;
  for (const Violation& violation : violations.kept()) {
    fields.push_back(violation.field);
  }
  EXPECT_THAT(fields,
              ElementsAre("recipe.roughness", "recipe.fidelity",
                          "recipe.domain.cells_x", "recipe.domain.cells_y",
                          "recipe.macro.parts[0].cone.radius",
                          "recipe.macro.parts[0].cone.height",
                          "recipe.continuous_constraints[0].target",
                          "recipe.continuous_constraints[0].reach",
                          "recipe.continuous_constraints[0].source"));
}

TEST(ValidateSpecTest, CountsAllVerticesOfARecipe) {
  SpecLimits limits;
  limits.max_vertices = 5;
  TerrainSpec spec;
  AddPart(&spec, Ridge{.crest = {{0, 0}, {1, 0}, {2, 0}}, .half_width = 1});
  spec.continuous_constraints = {PointConstraint(), PointConstraint()};
  for (ContinuousConstraint& constraint : spec.continuous_constraints) {
    constraint.kind = SourceKind::kPolyline;
    constraint.vertices.resize(2);
  }
  EXPECT_THAT(Validate(spec, limits),
              ElementsAre(Violation{
                  "continuous_constraints[1].polyline.vertices",
                  "the vertices of a whole recipe must be at most 5, got 7 up "
                  "to here"}));
}

TEST(ValidateSpecTest, CountsParts) {
  SpecLimits limits;
  limits.max_macro_parts = 1;
  TerrainSpec spec;
  AddPart(&spec, Plane{});
  AddPart(&spec, std::monostate{});
  EXPECT_THAT(Validate(spec, limits),
              ElementsAre(Violation{"macro.parts",
                                    "must have at most 1 elements, got 2"}));
}

TEST(ValidateSpecTest, AHostileSpecMakesAShortAnswer) {
  TerrainSpec spec;
  spec.continuous_constraints.resize(10'000);
  Violations violations;
  ValidateSpec(spec, SpecLimits{}, "recipe.", &violations);
  EXPECT_EQ(violations.kept().size(), Violations::kKept);
  EXPECT_EQ(violations.total(), 30'000u);
  EXPECT_THAT(violations.kept().front().field,
              StartsWith("recipe.continuous_constraints[0]"));
}

}  // namespace
}  // namespace terrane::core
