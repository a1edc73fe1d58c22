// Every rule of a TerrainSpec but for its macro shape, one case each, and what
// a whole validation does.
#include "core/terrain/validate.h"

#include <string>
#include <variant>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/validate_rule.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

void MakeRefinement(TerrainSpec* spec) {
  AddPart(spec, RasterShape{MakeRaster(9, 8)});
  spec->refinement = Refinement{};
}

ContinuousConstraint PointConstraint() {
  return {.target = 0.9, .reach = 2, .vertices = {{1, 2}}};
}

class ValidateRuleTest : public ::testing::TestWithParam<Rule> {};

TEST_P(ValidateRuleTest, NamesTheFieldTheRangeAndTheValue) {
  ExpectViolation(GetParam());
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
        Rule{"BufferNeedsMidpoint",
             [](TerrainSpec* s) {
               s->discrete_constraints.emplace_back();
               s->discrete_method = DiscreteMethod::kBuffer;
             },
             "discrete_method",
             "must be CONDITION with source SUBDIVISION, got BUFFER"},
        Rule{"BufferBesideSpots",
             [](TerrainSpec* s) {
               s->source = FractalSource::kMidpoint;
               s->discrete_method = DiscreteMethod::kBuffer;
               s->spots.points.emplace_back();
             },
             "discrete_method", "must be CONDITION with spot heights"},
        Rule{"SpotNan",
             [](TerrainSpec* s) {
               s->spots.points = {{}, {.point = {kNan, 0}}};
             },
             "spots.points[1].x", "got nan"},
        Rule{"SpotHeight",
             [](TerrainSpec* s) { s->spots.points = {{.height = 2e9}}; },
             "spots.points[0].height", "got 2e+09"},
        Rule{"SpotError",
             [](TerrainSpec* s) { s->spots.points = {{.standard_error = -1}}; },
             "spots.points[0].standard_error", "got -1"},
        Rule{"SpotLevel",
             [](TerrainSpec* s) {
               s->spots.points.emplace_back();
               s->spots.level = 31;
             },
             "spots.level", "must be in [0, 30], got 31"},
        Rule{"SpotTableRow",
             [](TerrainSpec* s) {
               s->spots.table = std::make_shared<std::vector<SpotHeight>>(
                   std::vector<SpotHeight>{{}, {.height = kNan}});
             },
             "spots.table[1].height", "got nan"},
        Rule{"SpotLineVertices",
             [](TerrainSpec* s) {
               s->spots.lines = {{.vertices = {{0, 0}}}};
             },
             "spots.lines[0].vertices", "at least 2"},
        Rule{"SpotLineHeights",
             [](TerrainSpec* s) {
               s->spots.lines = {
                   {.vertices = {{0, 0}, {1, 1}}, .heights = {1, 2, 3}}};
             },
             "spots.lines[0].heights", "one element a vertex, 2, or none"},
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

TEST(ValidateSpecTest, NoFieldOfSpotsHidesAnother) {
  TerrainSpec spec;
  spec.domain = Domain{8, 8};
  spec.spots.level = 31;
  spec.spots.points = {{.height = kNan}};
  spec.spots.table = std::make_shared<std::vector<SpotHeight>>(
      std::vector<SpotHeight>{{.point = {9, 0}}});
  spec.spots.lines = {{.vertices = {{kNan, 1}, {9, 1}},
                       .heights = {1, kNan, 2},
                       .spacing = -1}};
  EXPECT_THAT(
      FieldsOf(spec),
      ElementsAre("spots.level", "spots.points[0].height", "spots.table[0].x",
                  "spots.lines[0].vertices[0].x",
                  "spots.lines[0].vertices[1].x", "spots.lines[0].spacing",
                  "spots.lines[0].heights", "spots.lines[0].heights[1]"));
}

TEST(ValidateSpecTest, SamplesOfLinesAreCountedOnTheRefinedLattice) {
  TerrainSpec spec;
  spec.refinement.emplace();
  spec.spots.level = 0;
  spec.spots.lines = {{.vertices = {{0, 0}, {500'000, 0}}}};
  AddPart(&spec, RasterShape{MakeRaster(9, 8)});  // 10 apart
  EXPECT_THAT(FieldsOf(spec), IsEmpty());
  spec.spots.level = 3;
  EXPECT_THAT(FieldsOf(spec), ElementsAre("spots"));
  // Without the raster nothing is known of its lattice.
  spec.macro.parts = {{MacroCombine::kAdd, RasterShape{}}};
  EXPECT_THAT(FieldsOf(spec), ElementsAre("macro.parts[0].raster.raster_id"));
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
