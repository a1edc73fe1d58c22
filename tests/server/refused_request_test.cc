// Requests that the Actor refuses: each field that is wrong is named, whatever
// else is wrong or missing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/base/violations.h"
#include "server/actor/actor.h"
#include "server/actor/error_reason.h"
#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;

class RefusedRequestTest : public ::testing::Test {
 protected:
  absl::Status OpenError(const std::string& json) {
    return actor_->OpenTiles(FromJson<v1::StreamTilesRequest>(json), {})
        .status();
  }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 1);
};

TEST_F(RefusedRequestTest, UnknownNamesHaveAReason) {
  const absl::Status preset =
      OpenError(R"({"terrain": {"preset": "no/such"}})");
  EXPECT_EQ(preset.code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(ReasonOf(preset)->reason, kPresetNotFound);
  EXPECT_EQ(ReasonOf(preset)->value, "no/such");
  const absl::Status raster =
      OpenError(R"({"terrain": {"recipe": {"refinement": {}, "macro":
        {"parts": [{"raster": {"rasterId": "sha256:0"}}]}}}})");
  EXPECT_EQ(raster.code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(ReasonOf(raster)->reason, kRasterNotFound);
  EXPECT_EQ(ReasonOf(raster)->value, "sha256:0");
  EXPECT_EQ(actor_->GetRaster({}).status().code(), absl::StatusCode::kNotFound);
  const absl::Status table =
      OpenError(R"({"terrain": {"recipe": {"spots": {"tableId": "sha256:1"}}},
        "window": {"width": 1, "height": 1}})");
  EXPECT_EQ(ReasonOf(table)->reason, kSpotTableNotFound);
  EXPECT_EQ(ReasonOf(table)->key, "table_id");
  EXPECT_EQ(actor_->GetSpotTable({}).status().code(),
            absl::StatusCode::kNotFound);
}

// What is not there can be uploaded or renamed; what is wrong comes first.
TEST_F(RefusedRequestTest, WhatIsMissingHidesNoViolation) {
  const auto fields = [this](const std::string& json) {
    std::vector<std::string> found;
    for (const core::Violation& one : core::ViolationsOf(OpenError(json))) {
      found.push_back(one.field);
    }
    return found;
  };
  EXPECT_THAT(
      fields(R"({"terrain": {"preset": "no/such"}, "level": 99,
                         "encoding": 9, "window": {"width": -1}})"),
      ElementsAre("level", "window.width", "window.height", "encoding"));
  const std::string raster = R"("macro": {"parts": [{"raster": {"rasterId":
    "sha256:0"}}]})";
  EXPECT_THAT(
      fields(R"({"terrain": {"recipe": {"roughness": 2, )" + raster + "}}}"),
      ElementsAre("terrain.recipe.roughness"));
  EXPECT_THAT(fields(R"({"terrain": {"recipe": {"refinement": {}, )" + raster +
                     R"(}}, "firstTile": -1})"),
              ElementsAre("first_tile"));
  EXPECT_THAT(
      fields(R"({"terrain": {"recipe": {"spots": {"tableId": "sha256:1"},
                 "domain": {"cellsX": "4", "cellsY": "4"}}},
                 "window": {"x": 7, "width": 1, "height": 1}})"),
      ElementsAre("window.x"));
  const auto profile = actor_->GetProfile(
      FromJson<v1::GetProfileRequest>(
          R"({"terrain": {"preset": "no/such"}, "level": -1})"),
      {});
  EXPECT_THAT(core::ViolationsOf(profile.status()), testing::SizeIs(1));
  const auto heights = actor_->GetHeights(
      FromJson<v1::GetHeightsRequest>(
          R"({"terrain": {"preset": "no/such"}, "level": -1})"),
      {});
  EXPECT_THAT(core::ViolationsOf(heights.status()), testing::SizeIs(1));
}

TEST_F(RefusedRequestTest, RecipeAndRequestViolationsComeTogether) {
  const absl::Status status =
      OpenError(R"({"terrain": {"recipe": {"roughness": 1.7}},
        "level": 99, "window": {"width": -1, "height": 1}})");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(
      core::ViolationsOf(status),
      ElementsAre(core::Violation{"terrain.recipe.roughness",
                                  "must be in (0, 1), got 1.7"},
                  core::Violation{"level", "must be in [0, 40], got 99"},
                  core::Violation{"window.width",
                                  "must be in [1, 4503599627370496], got -1"}));
  EXPECT_THAT(core::ViolationsOf(OpenError("{}")).front(),
              (core::Violation{"terrain",
                               "must hold a recipe or a preset, got neither"}));
}

// Some faults show only when the terrain is made.
TEST_F(RefusedRequestTest, ViolationsOfPreparationHaveTheRequestsPath) {
  const auto upload = actor_->BeginRasterUpload();
  ASSERT_TRUE(upload
                  ->Add(FromJson<v1::UploadRasterRequest>(
                      R"({"header": {"width": "2", "height": "2"}})"))
                  .ok());
  v1::UploadRasterRequest chunk;
  chunk.set_chunk(std::string(16, '\0'));
  ASSERT_TRUE(upload->Add(chunk).ok());
  const std::string id = upload->Finish()->raster_id();
  const auto violations = core::ViolationsOf(
      OpenError(R"({"terrain": {"recipe": {"refinement": {}, "macro":
        {"parts": [{"raster": {"rasterId": ")" +
                id + R"("}}]}}}})"));
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].field, "terrain.recipe.macro.parts[0].raster");
}

}  // namespace
}  // namespace terrane::server
