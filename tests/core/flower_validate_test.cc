// Every rule of a FlowerSpec, one case each: the field, its range and the
// value.
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/flower/flower.h"
#include "core/flower/validate_flower.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/flower_presets.h"

namespace terrane::core {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Violation> Validate(const FlowerSpec& spec,
                                const FlowerLimits& limits = {}) {
  Violations violations;
  ValidateFlowerSpec(spec, limits, "", &violations);
  return violations.kept();
}

struct FlowerRule {
  std::string name;
  std::function<void(FlowerSpec*)> breaks;
  std::string field;
  std::string description;
};

std::string FlowerRuleName(const ::testing::TestParamInfo<FlowerRule>& rule) {
  return rule.param.name;
}

class FlowerRules : public ::testing::TestWithParam<FlowerRule> {};

TEST_P(FlowerRules, AreHeld) {
  const FlowerRule& rule = GetParam();
  FlowerSpec spec = FlowerPreset("rose");
  rule.breaks(&spec);
  EXPECT_THAT(Validate(spec),
              ElementsAre(AllOf(Field(&Violation::field, rule.field),
                                Field(&Violation::description,
                                      HasSubstr(rule.description)))));
}

Sketch& SketchOf(FlowerSpec* spec) { return spec->petals[0].blade.sketches[1]; }
BladeSpec& BladeOf(FlowerSpec* spec) { return spec->petals[0].blade; }

const std::vector<FlowerRule> kSketchRules = {
    {"TooFewPoints", [](FlowerSpec* s) { SketchOf(s).points.resize(1); },
     "petals[0].blade.sketches[1].points",
     "must have at least 2 elements, got 1"},
    {"TooManyPoints",
     [](FlowerSpec* s) {
       SketchOf(s).points = {{0.1, 0.2}, {0.1, 0.4}, {0.1, 0.6}, {0.1, 0.8}};
     },
     "petals[0].blade.sketches[1].points",
     "must have at most 3 elements, got 4"},
    {"PointLeftOfTheAxis",
     [](FlowerSpec* s) { SketchOf(s).points[0].x = -0.1; },
     "petals[0].blade.sketches[1].points[0].x", "must be in (0, 2], got -0.1"},
    {"PointNotFinite", [](FlowerSpec* s) { SketchOf(s).points[1].x = kNan; },
     "petals[0].blade.sketches[1].points[1].x", "must be in (0, 2], got nan"},
    {"PointsFall", [](FlowerSpec* s) { SketchOf(s).points[1].y = 0.2; },
     "petals[0].blade.sketches[1].points[1].y",
     "must be in (0.22, 1), got 0.2"},
    {"OutlineFoldsBack",
     [](FlowerSpec* s) {
       SketchOf(s).points = {{0.3, 0.1}, {0.3, 0.9}, {0.2, 0.91}};
     },
     "petals[0].blade.sketches[1]",
     "must not fold back between its points 0 and 1 of 0 (base) to 4 (tip)"},
    {"OutlineCrosses",
     [](FlowerSpec* s) {
       SketchOf(s).points = {{0.01, 0.3}, {1.5, 0.5}, {0.02, 0.6}};
       BladeOf(s).closed = BladeOf(s).open = {};
     },
     "petals[0].blade.sketches[1]", "must not cross the axis"},
    {"NoSketch", [](FlowerSpec* s) { BladeOf(s).sketches.clear(); },
     "petals[0].blade.sketches", "must have at least 1 elements, got 0"},
    {"ManySketches",
     [](FlowerSpec* s) { BladeOf(s).sketches.resize(17, SketchOf(s)); },
     "petals[0].blade.sketches", "must have at most 16 elements, got 17"}};

const std::vector<FlowerRule> kBladeRules = {
    {"Amplitude",
     [](FlowerSpec* s) { BladeOf(s).relief.amplitude = kInfinity; },
     "petals[0].blade.relief.amplitude", "must be in [0, 10], got inf"},
    {"FrequencyX", [](FlowerSpec* s) { BladeOf(s).relief.frequency_x = 65; },
     "petals[0].blade.relief.frequency_x", "must be in [0, 64], got 65"},
    {"FrequencyY", [](FlowerSpec* s) { BladeOf(s).relief.frequency_y = -1; },
     "petals[0].blade.relief.frequency_y", "must be in [0, 64], got -1"},
    {"Gain", [](FlowerSpec* s) { BladeOf(s).relief.gain = 0; },
     "petals[0].blade.relief.gain", "must be in (0, 100], got 0"},
    {"Variants", [](FlowerSpec* s) { BladeOf(s).variants = 0; },
     "petals[0].blade.variants", "must be in [1, 16], got 0"},
    {"Steps", [](FlowerSpec* s) { BladeOf(s).steps = 17; },
     "petals[0].blade.steps", "must be in [1, 16], got 17"},
    {"ColumnsOdd", [](FlowerSpec* s) { BladeOf(s).columns = 7; },
     "petals[0].blade.columns", "must be even, got 7"},
    {"Columns", [](FlowerSpec* s) { BladeOf(s).columns = 514; },
     "petals[0].blade.columns", "must be in [2, 512], got 514"},
    {"Rows", [](FlowerSpec* s) { BladeOf(s).rows = 1; }, "petals[0].blade.rows",
     "must be in [2, 1024], got 1"},
    {"Across", [](FlowerSpec* s) { BladeOf(s).open.across_deg = 800; },
     "petals[0].blade.open.across_deg", "must be in [-720, 720], got 800"},
    {"RolledUp", [](FlowerSpec* s) { BladeOf(s).closed.across_deg = 700; },
     "petals[0].blade.closed.across_deg", "got 700"},
    {"Curl", [](FlowerSpec* s) { BladeOf(s).open.tip_curl_deg = kNan; },
     "petals[0].blade.open.tip_curl_deg", "must be in [-720, 720], got nan"},
    {"Flare", [](FlowerSpec* s) { BladeOf(s).open.flare = 2; },
     "petals[0].blade.open.flare", "must be in [-1, 1], got 2"},
    {"ShapeRelief", [](FlowerSpec* s) { BladeOf(s).closed.relief = -1; },
     "petals[0].blade.closed.relief", "must be in [0, 10], got -1"},
    {"Color", [](FlowerSpec* s) { BladeOf(s).material.base_color[1] = 2; },
     "petals[0].blade.material.base_color.green", "must be in [0, 1], got 2"},
    {"Specular", [](FlowerSpec* s) { BladeOf(s).material.specular = 1; },
     "petals[0].blade.material.specular", "must be in [0, 1), got 1"},
    {"Middle", [](FlowerSpec* s) { BladeOf(s).colors.middle = 1; },
     "petals[0].blade.colors.middle", "must be in (0, 1), got 1"},
    {"Blotch",
     [](FlowerSpec* s) {
       BladeOf(s).colors.blotch = {{1, 1, 1}, 0.5, 0.4, 0};
     },
     "petals[0].blade.colors.blotch.to", "must be in (0.5, 2], got 0.4"}};

const std::vector<FlowerRule> kOrganRules = {
    {"Count", [](FlowerSpec* s) { s->petals[0].count = 0; }, "petals[0].count",
     "must be in [1, 100000], got 0"},
    {"AbsurdCount", [](FlowerSpec* s) { s->petals[0].count = 2'000'000'000; },
     "petals[0].count", "must be in [1, 100000], got 2000000000"},
    {"PetalOrgan",
     [](FlowerSpec* s) { s->petals[0].organ = FlowerOrgan::kStamen; },
     "petals[0].organ", "must be a petal, a sepal, a leaf or a floret"},
    {"Size", [](FlowerSpec* s) { s->petals[0].outer_size = 0; },
     "petals[0].outer_size", "must be in (0, 100], got 0"},
    {"Angle", [](FlowerSpec* s) { s->petals[0].angle_deg = 200; },
     "petals[0].angle_deg", "must be in [-180, 180], got 200"},
    {"Swirl", [](FlowerSpec* s) { s->petals[0].swirl_deg = 91; },
     "petals[0].swirl_deg", "must be in [-90, 90], got 91"},
    {"Divergence",
     [](FlowerSpec* s) { s->petals[0].arrangement.divergence_deg = 360; },
     "petals[0].arrangement.divergence_deg", "must be in (0, 360), got 360"},
    {"Layers", [](FlowerSpec* s) { s->petals[0].arrangement.layers = 65; },
     "petals[0].arrangement.layers", "must be in [1, 64], got 65"},
    {"Arc", [](FlowerSpec* s) { s->petals[0].arrangement.arc_deg = 0; },
     "petals[0].arrangement.arc_deg", "must be in (0, 360], got 0"},
    {"SolidOrgan",
     [](FlowerSpec* s) { s->solids[0].organ = FlowerOrgan::kPetal; },
     "solids[0].organ", "must be a stamen"},
    {"SolidEmpty", [](FlowerSpec* s) { s->solids[0].head_radius = 0; },
     "solids[0]", "must have a filament or a head"},
    {"SolidSides", [](FlowerSpec* s) { s->solids[0].sides = 2; },
     "solids[0].sides", "must be in [3, 64], got 2"},
    {"LeafletsEven", [](FlowerSpec* s) { s->leaves[0].leaflets = 4; },
     "leaves[0].leaflets", "must be odd, got 4"},
    {"LeavesTo", [](FlowerSpec* s) { s->leaves[0].to = 0.1; }, "leaves[0].to",
     "must be in [0.2, 1], got 0.1"},
    {"StemHeight", [](FlowerSpec* s) { s->stem->height = kNan; }, "stem.height",
     "must be in (0, 1000], got nan"},
    {"StemFolds",
     [](FlowerSpec* s) {
       s->stem->nod_deg = 90;
       s->stem->bend = 0;
       s->stem->height = 1;
       s->stem->radius = 0.2;
     },
     "stem.radius", "must be in (0, 0.106103"},
    {"StemBend", [](FlowerSpec* s) { s->stem->bend = 0.6; }, "stem.bend",
     "must be in [0, 0.5], got 0.6"},
    {"ManyGroups", [](FlowerSpec* s) { s->petals.resize(17, s->petals[0]); },
     "petals", "must have at most 16 elements, got 17"},
    {"Nothing", [](FlowerSpec* s) { *s = {}; }, "petals",
     "must have at least 1 elements"}};

const std::vector<FlowerRule> kPlantRules = {
    {"Unit", [](FlowerSpec* s) { s->unit_m = 0; }, "unit_m",
     "must be in (0, 10], got 0"},
    {"Stage", [](FlowerSpec* s) { s->stage = 1.5; }, "stage",
     "must be in [0, 1], got 1.5"},
    {"Buds", [](FlowerSpec* s) { s->early.buds = -1; }, "early.buds",
     "must be in [0, 1e+05], got -1"},
    {"AngleRatio", [](FlowerSpec* s) { s->full.angle_ratio = 1.1; },
     "full.angle_ratio", "must be in [0, 1], got 1.1"},
    {"StageSize", [](FlowerSpec* s) { s->full.size = kInfinity; }, "full.size",
     "must be in (0, 100], got inf"},
    {"Variation", [](FlowerSpec* s) { s->variation = -0.1; }, "variation",
     "must be in [0, 1], got -0.1"},
    {"Plants", [](FlowerSpec* s) { s->bed.plants = 0; }, "bed.plants",
     "must be in [1, 1000000], got 0"},
    {"Spacing", [](FlowerSpec* s) { s->bed.spacing_m = 0; }, "bed.spacing_m",
     "must be in (0, 100], got 0"},
    {"Jitter", [](FlowerSpec* s) { s->bed.jitter = 2; }, "bed.jitter",
     "must be in [0, 1], got 2"}};

INSTANTIATE_TEST_SUITE_P(Sketch, FlowerRules, ::testing::ValuesIn(kSketchRules),
                         FlowerRuleName);
INSTANTIATE_TEST_SUITE_P(Blade, FlowerRules, ::testing::ValuesIn(kBladeRules),
                         FlowerRuleName);
INSTANTIATE_TEST_SUITE_P(Organ, FlowerRules, ::testing::ValuesIn(kOrganRules),
                         FlowerRuleName);
INSTANTIATE_TEST_SUITE_P(Plant, FlowerRules, ::testing::ValuesIn(kPlantRules),
                         FlowerRuleName);

TEST(FlowerValidation, PresetsAreValid) {
  for (const std::string& name : FlowerPresetNames()) {
    EXPECT_THAT(Validate(FlowerPreset(name)), IsEmpty()) << name;
  }
}

TEST(FlowerValidation, CollectsEveryViolationAfterThePrefix) {
  FlowerSpec spec = FlowerPreset("rose");
  spec.unit_m = -1;
  spec.petals[0].count = 0;
  spec.bed.jitter = kNan;
  Violations violations;
  ValidateFlowerSpec(spec, {}, "recipe.", &violations);
  EXPECT_THAT(violations.kept(),
              ElementsAre(Field(&Violation::field, "recipe.unit_m"),
                          Field(&Violation::field, "recipe.petals[0].count"),
                          Field(&Violation::field, "recipe.bed.jitter")));
}

TEST(FlowerValidation, NoFieldHidesAnother) {
  FlowerSpec spec = FlowerPreset("rose");
  SketchOf(&spec).points = {{-1, kNan}, {3, 0.4}, {0.2, 0.3}, {kNan, kNan}};
  BladeOf(&spec).colors.blotch = {{1, 1, 1}, -1, 3, 0};
  spec.leaves[0].from = -1;
  spec.leaves[0].to = 2;
  std::vector<std::string> fields;
  for (const Violation& one : Validate(spec)) fields.push_back(one.field);
  const std::string blade = "petals[0].blade.";
  const std::string points = blade + "sketches[1].points";
  EXPECT_THAT(fields, ElementsAre(points, points + "[0].x", points + "[0].y",
                                  points + "[1].x", points + "[2].y",
                                  blade + "colors.blotch.from",
                                  blade + "colors.blotch.to", "leaves[0].from",
                                  "leaves[0].to"));
}

TEST(FlowerValidation, SizesAreHeldBeforeAnythingIsMade) {
  FlowerSpec spec = FlowerPreset("rose");
  // 16 * 16 * 16 meshes of 512 * 1024 cells: 120 GB.
  BladeSpec& blade = spec.petals[0].blade;
  blade.sketches.resize(16, blade.sketches[0]);
  blade.variants = blade.steps = 16;
  blade.columns = 512;
  blade.rows = 1024;
  EXPECT_THAT(
      Validate(spec),
      ElementsAre(AllOf(
          Field(&Violation::field, "petals"),
          Field(&Violation::description,
                HasSubstr("must make prototypes of at most 268435456 bytes, "
                          "got ")))));
  spec = FlowerPreset("sunflower");
  spec.bed.plants = 1'000'000;
  EXPECT_THAT(Validate(spec),
              ElementsAre(AllOf(Field(&Violation::field, "bed.plants"),
                                Field(&Violation::description,
                                      HasSubstr("must make at most 100000000 "
                                                "instances, got 1")))));
  EXPECT_FALSE(Flower::Create(spec).ok());
}

}  // namespace
}  // namespace terrane::core
