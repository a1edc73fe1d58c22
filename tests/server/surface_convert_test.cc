#include "server/convert/surface_convert.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

constexpr char kRecipe[] = R"({
  "seed": "-5", "method": "SURFACE_METHOD_TWO_TERMS",
  "net": {"basis": "SPLINE_BASIS_BICUBIC_HERMITE", "columns": 2, "rows": 2,
          "points": [{}, {"x": 1}, {"y": 1}, {"x": 1, "y": 1, "z": 2}]},
  "network": {"weights": [{"i": 0, "slopeI": 2, "redraw": true}],
              "desired": 0, "desiredRandom": 0.3},
  "networkU": {"weights": [{"j": 1, "offset": 3, "slopeJ": -1, "random": -12}]},
  "training": {"learningRate": 0.25, "iterations": 9},
  "carryOver": true, "direction": {"x": 1, "z": 2}, "holeLevel": -3})";

core::SurfaceSpec Read(const std::string& json, core::Violations* violations) {
  return ReadSurfaceRecipe(FromJson<v1::SurfaceRecipe>(json), "r.", violations);
}

TEST(SurfaceConvertTest, WhatIsWrittenReadsBackAsTheSame) {
  core::Violations violations;
  const v1::SurfaceRecipe once = WriteSurfaceRecipe(Read(kRecipe, &violations));
  EXPECT_TRUE(violations.empty()) << violations.ToStatus();
  const v1::SurfaceRecipe twice =
      WriteSurfaceRecipe(ReadSurfaceRecipe(once, "", &violations));
  using google::protobuf::util::MessageDifferencer;
  EXPECT_TRUE(MessageDifferencer::Equals(once, twice));
  const v1::SurfaceRecipe given = FromJson<v1::SurfaceRecipe>(kRecipe);
  EXPECT_TRUE(MessageDifferencer::Equals(once.training(), given.training()));
  EXPECT_TRUE(MessageDifferencer::Equals(once.direction(), given.direction()));
  EXPECT_EQ(once.network().weights(0).i(), 0);
  EXPECT_TRUE(once.network().weights(0).has_i());
  EXPECT_FALSE(once.network().weights(0).has_j());
  EXPECT_EQ(once.network_u().weights(0).random(), -12);
  EXPECT_EQ(once.hole_level(), -3);
}

TEST(SurfaceConvertTest, DefaultsAreFilledIn) {
  core::Violations violations;
  const v1::SurfaceRecipe recipe = WriteSurfaceRecipe(
      Read(R"({"net": {"columns": 4, "rows": 4, "points": [{}, {}, {}, {}, {},
           {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}]}})",
           &violations));
  EXPECT_TRUE(violations.empty()) << violations.ToStatus();
  EXPECT_EQ(recipe.net().basis(), v1::SPLINE_BASIS_BSPLINE_CLAMPED);
  EXPECT_EQ(recipe.net().degree(), 3);
  EXPECT_EQ(recipe.method(), v1::SURFACE_METHOD_PRODUCTS);
  EXPECT_EQ(recipe.network().desired(), 1);
  EXPECT_EQ(recipe.direction().z(), 1);
  EXPECT_FALSE(recipe.has_training());
  EXPECT_FALSE(recipe.has_network_u());
}

TEST(SurfaceConvertTest, ViolationsNameTheFieldInTheRequest) {
  core::Violations violations;
  Read(R"({"net": {"columns": 2, "rows": 2, "basis": 99,
       "points": [{}, {}, {}, {"x": "NaN"}]}, "method": 42, "direction": {}})",
       &violations);
  EXPECT_THAT(
      violations.kept(),
      UnorderedElementsAre(Field(&core::Violation::field, "r.net.basis"),
                           Field(&core::Violation::field, "r.net.degree"),
                           Field(&core::Violation::field, "r.net.points[3].x"),
                           Field(&core::Violation::field, "r.method"),
                           Field(&core::Violation::field, "r.direction")));
}

SurfacePlan Plan(const std::string& json, core::Violations* violations) {
  return PlanSurface(FromJson<v1::StreamSurfaceRequest>(json), nullptr, {}, "",
                     "surface.recipe.", violations);
}

std::string PlanError(const std::string& json) {
  core::Violations violations;
  Plan(json, &violations);
  return std::string(violations.ToStatus().message());
}

TEST(SurfacePlanTest, TilesCoverTheWindow) {
  core::Violations violations;
  SurfacePlan plan = Plan(R"({"columns": 513, "rows": 257})", &violations);
  EXPECT_EQ(plan.tiles.columns, 3);
  EXPECT_EQ(plan.tiles.rows, 2);
  EXPECT_EQ(plan.tiles.TileWindow(2, 1), (core::Window{512, 256, 1, 1}));
  plan = Plan(R"({"columns": 513, "rows": 257, "tileSize": 257,
                  "shareEdges": true})",
              &violations);
  EXPECT_EQ(plan.tiles.columns, 2);
  EXPECT_EQ(plan.tiles.rows, 1);
  EXPECT_EQ(plan.tiles.TileWindow(1, 0), (core::Window{256, 0, 257, 257}));
  plan = Plan(R"({"columns": 100, "rows": 100, "window": {"x": 7, "y": 9,
                  "width": 20, "height": 1}, "tileSize": 8})",
              &violations);
  EXPECT_EQ(plan.tiles.columns, 3);
  EXPECT_EQ(plan.tiles.rows, 1);
  EXPECT_EQ(plan.tiles.TileWindow(2, 0), (core::Window{23, 9, 4, 1}));
  EXPECT_TRUE(violations.empty()) << violations.ToStatus();
}

TEST(SurfacePlanTest, NamesWhatIsWrong) {
  EXPECT_THAT(PlanError(R"({"rows": 9})"),
              HasSubstr("columns: must be in [2, 1048576], got 0"));
  EXPECT_THAT(PlanError(R"({"columns": 9, "rows": 9, "tileSize": 5000})"),
              HasSubstr("tile_size: must be in [1, 1025], got 5000"));
  EXPECT_THAT(PlanError(R"({"columns": 9, "rows": 9,
                            "window": {"x": 4, "width": 6, "height": 2}})"),
              HasSubstr("window.width: must be in [1, 5], got 6"));
  EXPECT_THAT(PlanError(R"({"columns": 9, "rows": 9, "firstTile": 2})"),
              HasSubstr("first_tile: must be in [0, 1], got 2"));
  EXPECT_THAT(PlanError(R"({"columns": 9, "rows": 9, "output": 5})"),
              HasSubstr("output: must be a value that the API knows, got 5"));
  EXPECT_THAT(PlanError(R"({"columns": 9, "rows": 9,
                    "output": "SURFACE_OUTPUT_HEIGHTS",
                    "encoding": "HEIGHT_ENCODING_UINT16_LE"})"),
              HasSubstr("range: must be set with UINT16_LE"));
  EXPECT_THAT(PlanError(R"({"columns": 1048576, "rows": 1048576})"),
              HasSubstr("window: must have at most 68719476736 samples, got "
                        "1099511627776"));
}

std::vector<std::string> PlanFields(const std::string& json,
                                    const Limits& limits = {}) {
  core::Violations violations;
  PlanSurface(FromJson<v1::StreamSurfaceRequest>(json), nullptr, limits, "",
              "surface.recipe.", &violations);
  std::vector<std::string> fields;
  for (const core::Violation& one : violations.kept()) {
    fields.push_back(one.field);
  }
  return fields;
}

// A wrong field hides none of the others.
TEST(SurfacePlanTest, NoFieldHidesAnother) {
  EXPECT_THAT(
      PlanFields(R"({"columns": 1, "rows": 9, "tileSize": 5000, "output": 5,
                     "encoding": 9, "range": {"minimum": 1, "maximum": 0},
                     "window": {"x": -1, "width": 0, "y": 9, "height": 99},
                     "firstTile": -1})"),
      ElementsAre("columns", "tile_size", "output", "encoding", "range.maximum",
                  "window.x", "window.width", "window.y", "window.height",
                  "first_tile"));
  EXPECT_THAT(PlanFields(R"({"columns": 9, "rows": 9, "encoding": 9})"),
              ElementsAre("encoding"));
  EXPECT_THAT(PlanFields(R"({"columns": 1048576, "rows": 1048576,
                             "tileSize": -1, "firstTile": -1})"),
              ElementsAre("tile_size", "window", "first_tile"));
}

// What depends on a field that is wrong is not guessed at.
TEST(SurfacePlanTest, AWrongFieldAccusesNoOther) {
  EXPECT_THAT(PlanFields(R"({"columns": -1, "rows": 9, "firstTile": 1000,
                             "window": {"x": 500, "width": 600, "y": 0,
                                        "height": 9}, "tileSize": 1})"),
              ElementsAre("columns"));
  EXPECT_THAT(PlanFields(R"({"columns": 9, "rows": 9, "firstTile": 1000,
                             "tileSize": -1})"),
              ElementsAre("tile_size"));
  Limits limits;
  limits.max_tile_size = 1;
  EXPECT_THAT(PlanFields(R"({"columns": 9, "rows": 9, "tileSize": 1,
                             "shareEdges": true})",
                         limits),
              ElementsAre("tile_size"));
}

}  // namespace
}  // namespace terrane::server
