#include "core/surface/validate_surface.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/surface/surface.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/surface_reference.h"

namespace terrane::core {
namespace {

struct SurfaceRule {
  std::string name;
  std::function<void(SurfaceSpec*)> breaks;
  std::string field;
  std::string description;
};

class SurfaceRuleTest : public ::testing::TestWithParam<SurfaceRule> {};

// Breaking the rule makes one violation: of its field, with its description.
TEST_P(SurfaceRuleTest, IsNamed) {
  SurfaceSpec spec;
  spec.net = HillNet();
  GetParam().breaks(&spec);
  Violations violations;
  ValidateSurface(spec, "", &violations);
  ASSERT_EQ(violations.total(), 1u);
  EXPECT_EQ(violations.kept()[0].field, GetParam().field);
  EXPECT_THAT(violations.kept()[0].description,
              ::testing::HasSubstr(GetParam().description));
  EXPECT_FALSE(Surface::Create(spec).ok());
}

const std::vector<SurfaceRule> kRules = {
    {"EmptyNet", [](SurfaceSpec* s) { s->net.points.clear(); }, "net.points",
     "must have rows * columns = 16 elements, got 0"},
    {"RaggedNet", [](SurfaceSpec* s) { s->net.points.pop_back(); },
     "net.points", "must have rows * columns = 16 elements, got 15"},
    {"OneColumn", [](SurfaceSpec* s) { s->net.columns = 1; }, "net.columns",
     "must be in [2, 64], got 1"},
    {"TooManyRows", [](SurfaceSpec* s) { s->net.rows = 65; }, "net.rows",
     "must be in [2, 64], got 65"},
    {"NotANumber", [](SurfaceSpec* s) { s->net.points[5].y = std::nan(""); },
     "net.points[5].y", "must be in [-1e+09, 1e+09], got nan"},
    {"Infinite",
     [](SurfaceSpec* s) {
       s->net.points[6].z = std::numeric_limits<double>::infinity();
     },
     "net.points[6].z", "got inf"},
    {"DegreeTooHighForTheNet",
     [](SurfaceSpec* s) {
       s->net.basis = SplineBasis::kBSplineClamped;
       s->net.degree = 4;
     },
     "net.degree", "must be below the number of control points, 4, got 4"},
    {"DegreeTooHigh",
     [](SurfaceSpec* s) {
       s->net.basis = SplineBasis::kBSplineUniform;
       s->net.degree = 6;
     },
     "net.degree", "must be in [1, 5], got 6"},
    {"SelectorOutsideTheNet",
     [](SurfaceSpec* s) { s->network.weights = {{.i = 4}}; },
     "network.weights[0].i", "must be in [0, 3], got 4"},
    {"SelectorBelowTheNet",
     [](SurfaceSpec* s) {
       s->network.weights = {{}, {.j = -1}};
     },
     "network.weights[1].j", "must be in [0, 3], got -1"},
    {"SelectorOfNoAxis",
     [](SurfaceSpec* s) {
       s->method = SurfaceMethod::kAlongT;
       s->network.weights = {{.j = 1}};
     },
     "network.weights[0].j", "the network has no such axis"},
    {"SlopeOfNoAxis",
     [](SurfaceSpec* s) {
       s->method = SurfaceMethod::kTwoTerms;
       s->network_u.weights = {{.slope_i = 2}};
     },
     "network_u.weights[0].slope_i", "has no such axis, got 2"},
    {"WeightNotANumber",
     [](SurfaceSpec* s) { s->network.weights = {{.offset = std::nan("")}}; },
     "network.weights[0].offset", "got nan"},
    {"RedrawWithoutCarryOver",
     [](SurfaceSpec* s) { s->network.weights = {{.redraw = true}}; },
     "network.weights[0].redraw", "needs carry_over"},
    {"DesiredTooLarge", [](SurfaceSpec* s) { s->network.desired = 2e6; },
     "network.desired", "got 2e+06"},
    {"RateDiverges",
     [](SurfaceSpec* s) {
       s->training = Training{1.0, 3};
     },
     "training.learning_rate",
     "diverges: must be below 1 / max |x|^2 = 1, got 1"},
    {"RateIsZero",
     [](SurfaceSpec* s) {
       s->training = Training{0, 3};
     },
     "training.learning_rate", "must be in (0, 1e+06], got 0"},
    {"NegativeIterations",
     [](SurfaceSpec* s) {
       s->training = Training{0.5, -1};
     },
     "training.iterations", "must be in [0, 1000000], got -1"},
    {"ZeroDirection",
     [](SurfaceSpec* s) {
       s->direction = {0, 0, 0};
     },
     "direction", "must not be the zero vector"},
    {"HoleLevelNotANumber",
     [](SurfaceSpec* s) { s->hole_level = std::nan(""); }, "hole_level",
     "got nan"}};

std::string SurfaceRuleName(const ::testing::TestParamInfo<SurfaceRule>& rule) {
  return rule.param.name;
}

INSTANTIATE_TEST_SUITE_P(All, SurfaceRuleTest, ::testing::ValuesIn(kRules),
                         SurfaceRuleName);

// A uniform B-spline never has |x|^2 = 1, so it takes larger rates, and not
// more than that.
TEST(ValidateSurfaceTest, TheRateIsHeldAgainstTheLargestInputOfTheBasis) {
  SurfaceSpec spec;
  spec.net = WavyNet(SplineBasis::kBSplineUniform, 3, 8, 8);
  spec.training = Training{3.9, 10};
  EXPECT_TRUE(Surface::Create(spec).ok());
  spec.training = Training{4.1, 10};
  EXPECT_THAT(std::string(Surface::Create(spec).status().message()),
              ::testing::HasSubstr("training.learning_rate: diverges"));
}

TEST(ValidateSurfaceTest, EveryViolationIsCollected) {
  SurfaceSpec spec;
  spec.net = HillNet();
  spec.net.points[0].x = std::nan("");
  spec.network.desired = 1e9;
  spec.direction = {};
  Violations violations;
  ValidateSurface(spec, "recipe.", &violations);
  ASSERT_EQ(violations.total(), 3u);
  EXPECT_EQ(violations.kept()[0].field, "recipe.net.points[0].x");
}

// A wrong field hides none of the others.
TEST(ValidateSurfaceTest, NoFieldHidesAnother) {
  SurfaceSpec spec;
  spec.net = HillNet();
  spec.net.basis = SplineBasis::kBSplineClamped;
  spec.net.columns = 1;
  spec.net.degree = 6;
  spec.net.points[2].z = std::nan("");
  spec.network.weights = {{.i = 64, .random = std::nan("")}};
  spec.network.desired = 1e9;
  spec.training = Training{-1, -1};
  Violations violations;
  ValidateSurface(spec, "", &violations);
  std::vector<std::string> fields;
  for (const Violation& one : violations.kept()) fields.push_back(one.field);
  EXPECT_THAT(fields, ::testing::ElementsAre(
                          "net.columns", "net.degree", "net.points[2].z",
                          "network.weights[0].i", "network.weights[0].random",
                          "network.desired", "training.iterations",
                          "training.learning_rate"));
}

std::string HeightFieldError(const SurfaceSpec& spec) {
  Violations violations;
  ValidateHeightField(spec, "", &violations);
  return std::string(violations.ToStatus().message());
}

TEST(ValidateSurfaceTest, AHeightFieldNeedsAGraph) {
  SurfaceSpec spec;
  spec.net = HillNet();
  EXPECT_EQ(HeightFieldError(spec), "");
  SurfaceSpec folds = spec;
  for (std::size_t j = 0; j < 4; ++j) folds.net.points[4 * j + 2].x = 0.5;
  EXPECT_THAT(HeightFieldError(folds),
              ::testing::HasSubstr("net.points: fold over: x must rise"));
  SurfaceSpec crooked = spec;
  crooked.net.points[5].x = 1.25;
  EXPECT_THAT(HeightFieldError(crooked),
              ::testing::HasSubstr("net.points[5].x: must be that of its "
                                   "column, 1, for a height field, got 1.25"));
  SurfaceSpec slanted = spec;
  slanted.direction = {0, 1, 1};
  EXPECT_THAT(HeightFieldError(slanted), ::testing::HasSubstr("direction: "));
  // Rises at the control points, but a tangent of 5.05 makes it overshoot.
  SurfaceSpec overshoots = spec;
  overshoots.net.basis = SplineBasis::kBicubicHermite;
  for (std::size_t j = 0; j < 4; ++j) {
    overshoots.net.points[4 * j + 2].x = 1.1;
    overshoots.net.points[4 * j + 3].x = 11;
  }
  EXPECT_THAT(HeightFieldError(overshoots), ::testing::HasSubstr("fold over"));
}

}  // namespace
}  // namespace terrane::core
