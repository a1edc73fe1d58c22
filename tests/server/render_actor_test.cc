// Pictures through the Actor: stages, bands, resuming, subjects, estimates,
// limits, errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/base/violations.h"
#include "server/actor/actor.h"
#include "server/convert/column_checksum.h"
#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kSurface[] = R"("surface": {"surface": {"preset":
  "surface/fig07"}, "columns": "33", "rows": "33"})";
constexpr char kTree[] = R"("tree": {"tree": {"recipe": {"dimensions": 3,
  "depth": 5, "leaves": {}}}})";

v1::StreamRenderRequest Asked(const std::string& subject,
                              const std::string& more) {
  return FromJson<v1::StreamRenderRequest>("{" + subject + ", " + more + "}");
}

class RenderActorTest : public ::testing::Test {
 protected:
  std::vector<v1::StreamRenderResponse> Run(
      const v1::StreamRenderRequest& request) {
    std::vector<v1::StreamRenderResponse> messages;
    const auto run = actor_->renders().Open(request, {});
    EXPECT_TRUE(run.ok()) << run.status();
    double share = 0;
    while (run.ok() && !(*run)->Done()) {
      v1::StreamRenderResponse& message = messages.emplace_back();
      const absl::Status status = (*run)->Next({}, &message);
      EXPECT_TRUE(status.ok()) << status;
      if (!status.ok()) break;
      EXPECT_EQ(message.has_header(), messages.size() == 1);
      if (!message.has_progress()) continue;
      EXPECT_GE(message.progress().share(), share);
      EXPECT_LE(message.progress().share(), 1);
      share = message.progress().share();
      messages.pop_back();
    }
    return messages;
  }

  std::vector<std::string> FieldsOf(const v1::StreamRenderRequest& request) {
    std::vector<std::string> fields;
    const auto run = actor_->renders().Open(request, {});
    for (const core::Violation& one : core::ViolationsOf(run.status())) {
      fields.push_back(one.field);
    }
    return fields;
  }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 1);
};

std::string PixelsOf(const std::vector<v1::StreamRenderResponse>& messages,
                     int passes) {
  std::string pixels;
  for (const v1::StreamRenderResponse& message : messages) {
    if (message.band().passes() == passes) pixels += message.band().pixels();
  }
  return pixels;
}

TEST_F(RenderActorTest, PicturesComeAfterPowersOfTwoAndAtTheEnd) {
  // 1,000 x 100 pixels take two bands.
  const auto request =
      Asked(kSurface, R"("width": 1000, "height": 100, "passes": 5,
                         "bounces": 0)");
  const auto messages = Run(request);
  const v1::RenderHeader& header = messages.front().header();
  EXPECT_EQ(header.width(), 1000);
  EXPECT_EQ(header.height(), 100);
  EXPECT_EQ(header.passes(), 5);
  EXPECT_EQ(header.band_rows(), 65);
  EXPECT_EQ(header.bands(), 8);
  EXPECT_THAT(header.recipe_hash(), HasSubstr("sha256:"));
  ASSERT_EQ(messages.size(), 9u);
  for (int k = 0; k < 8; ++k) {
    const v1::RenderBand& band =
        messages[static_cast<std::size_t>(k) + 1].band();
    EXPECT_EQ(band.index(), k);
    EXPECT_EQ(band.passes(),
              std::vector({1, 2, 4, 5})[static_cast<std::size_t>(k) / 2]);
    EXPECT_EQ(band.first_row(), k % 2 * 65);
    EXPECT_EQ(band.rows(), k % 2 == 0 ? 65 : 35);
    EXPECT_EQ(band.pixels().size(),
              static_cast<std::size_t>(band.rows()) * 3000);
    EXPECT_EQ(band.checksum(), ColumnChecksum({&band.pixels()}));
  }
  EXPECT_NE(PixelsOf(messages, 1), PixelsOf(messages, 2));
}

TEST_F(RenderActorTest, TheEndIsTheSameWhateverCameBefore) {
  auto request = Asked(kSurface, R"("width": 40, "height": 30, "passes": 5)");
  const std::string all = PixelsOf(Run(request), 5);
  EXPECT_EQ(all.size(), 40u * 30 * 3);
  request.set_first_band(3);
  const auto resumed = Run(request);
  ASSERT_EQ(resumed.size(), 2u);
  EXPECT_EQ(resumed.back().band().index(), 3);
  EXPECT_EQ(resumed.back().band().pixels(), all);
  request.set_first_band(0);
  request.set_final_only(true);
  const auto last = Run(request);
  ASSERT_EQ(last.size(), 2u);
  EXPECT_EQ(last.back().band().index(), 0);
  EXPECT_EQ(last.back().band().pixels(), all);
}

TEST_F(RenderActorTest, LongBandsTellTheirProgress) {
  // 200 passes of 16,000 pixels are many tasks of one band.
  const auto request =
      Asked(kSurface, R"("width": 160, "height": 100, "passes": 20,
                         "bounces": 0, "finalOnly": true)");
  const auto run = actor_->renders().Open(request, {});
  ASSERT_TRUE(run.ok()) << run.status();
  int told = 0;
  for (v1::StreamRenderResponse message; !(*run)->Done();) {
    ASSERT_TRUE((*run)->Next({}, &message).ok());
    if (message.has_progress() && message.progress().share() > 0.1) ++told;
  }
  EXPECT_EQ(told, 4);  // 4 passes each; the fifth task gives the band
}

TEST_F(RenderActorTest, EverySubjectIsSeen) {
  for (const char* subject :
       {kSurface, kTree,
        R"("terrain": {"terrain": {"preset": "demo/hills"}, "level": 0,
           "window": {"width": "40", "height": "40"}, "exaggeration": 2})"}) {
    for (const char* ground : {"false", "true"}) {
      const auto request =
          Asked(subject, std::string(R"("width": 24, "height": 24, "passes": 4,
              "encoding": "PIXEL_ENCODING_LINEAR_FLOAT32_LE",
              "finalOnly": true, "ground": )") +
                             ground);
      const std::string pixels = PixelsOf(Run(request), 4);
      ASSERT_EQ(pixels.size(), 24u * 24 * 12) << subject;
      const auto value = [&](int x, int y) {
        float red = 0;
        std::memcpy(&red, pixels.data() + 12 * (24 * y + x), sizeof(red));
        return red;
      };
      // The sky at a corner, something else in other places.
      EXPECT_GT(value(0, 0), 0.3f) << subject;
      int others = 0;
      for (int k = 0; k < 24 * 24; ++k) {
        const float red = value(k % 24, k / 24);
        EXPECT_GE(red, 0);
        others += red != value(0, 0) ? 1 : 0;
      }
      EXPECT_GT(others, 20) << subject;
    }
  }
}

TEST_F(RenderActorTest, AnEstimateIsWhatComes) {
  v1::EstimateRenderRequest asked;
  *asked.mutable_request() = Asked(
      kSurface, R"("width": 1000, "height": 100, "passes": 3, "bounces": 0,
                   "firstBand": 1)");
  const auto estimate = actor_->renders().Estimate(asked, {});
  ASSERT_TRUE(estimate.ok()) << estimate.status();
  const auto messages = Run(asked.request());
  std::int64_t bytes = 0;
  for (const auto& message : messages) {
    bytes += static_cast<std::int64_t>(message.band().pixels().size());
  }
  EXPECT_EQ(estimate->bands(), static_cast<std::int64_t>(messages.size()) - 1);
  EXPECT_EQ(estimate->data_bytes(), bytes);
  EXPECT_EQ(estimate->triangles_most(), 2 * 32 * 32);
  EXPECT_EQ(estimate->paths(), 300'000);
  EXPECT_GT(estimate->cpu_seconds(), 0);
  EXPECT_GT(estimate->memory_bytes_most(), 12 * 100'000);
}

TEST_F(RenderActorTest, ViolationsHaveThePathsOfTheRequest) {
  EXPECT_THAT(
      FieldsOf(Asked(R"("seed": "1")", R"("width": -1,
      "height": 20000, "passes": 5000, "bounces": 17, "firstBand": -1,
      "exposure": 0, "shading": 9, "encoding": 9,
      "view": {"turnDeg": 400, "tiltDeg": 91, "fieldOfViewDeg": 0.5},
      "light": {"distance": 1, "halfSide": 0, "irradiance": {"red": -1}},
      "groundMaterial": {"roughness": 2})")),
      ElementsAre("width", "height", "passes", "bounces", "shading", "encoding",
                  "exposure", "view.turn_deg", "view.tilt_deg",
                  "view.field_of_view_deg", "light.distance", "light.half_side",
                  "light.irradiance.red", "ground_material.base_color",
                  "ground_material.roughness", "first_band", "subject"));
  EXPECT_THAT(FieldsOf(Asked(R"("surface": {"columns": "5"})", R"("seed": 1)")),
              ElementsAre("surface.surface", "surface.rows"));
  EXPECT_THAT(FieldsOf(Asked(R"("tree": {"tree": {"recipe": {"depth": 99}},
                                "bark": {"gloss": 2}})",
                             R"("seed": 1)")),
              ElementsAre("tree.bark.base_color", "tree.bark.gloss",
                          "tree.tree.recipe.depth"));
  EXPECT_THAT(
      FieldsOf(Asked(R"("terrain": {"level": -1, "exaggeration": 0})",
                     R"("seed": 1)")),
      ElementsAre("terrain.exaggeration", "terrain.terrain", "terrain.level"));
}

TEST_F(RenderActorTest, AnEstimateHasTheViolationsToo) {
  v1::EstimateRenderRequest asked;
  for (const auto& [subject, field] :
       {std::pair{R"("surface": {"surface": {"preset": "surface/fig07"},
                     "columns": "1", "rows": "33"})",
                  "request.surface.columns"},
        std::pair{R"("tree": {"tree": {"recipe": {"depth": 99}}})",
                  "request.tree.tree.recipe.depth"},
        std::pair{R"("terrain": {"terrain": {"preset": "demo/hills"},
                     "window": {"width": "9", "height": "9"}, "level": 99})",
                  "request.terrain.level"},
        std::pair{R"("terrain": {"terrain": {"preset": "demo/hills"},
                     "window": {"width": "1", "height": "9"}})",
                  "request.terrain.window"},
        // So many faces that counting their bytes would overflow.
        std::pair{R"("tree": {"tree": {"recipe": {"form":
                     "TREE_FORM_PLAIN", "depth": 22}},
                     "tubes": {"sides": 2147483647}})",
                  "request.tree.tubes.sides"}}) {
    *asked.mutable_request() = Asked(subject, R"("seed": 1)");
    const auto estimate = actor_->renders().Estimate(asked, {});
    const auto violations = core::ViolationsOf(estimate.status());
    ASSERT_EQ(violations.size(), 1u) << estimate.status();
    EXPECT_EQ(violations.front().field, field);
  }
}

TEST_F(RenderActorTest, LargeScenesAreRefused) {
  const auto surface = actor_->renders().Open(
      Asked(R"("surface": {"surface": {"preset": "surface/fig07"},
               "columns": "4000", "rows": "4000"})",
            R"("seed": 1)"),
      {});
  EXPECT_TRUE(absl::IsResourceExhausted(surface.status())) << surface.status();

  Limits limits;
  limits.render_bytes = 1'000'000;
  const std::unique_ptr<Actor> small = MakeActor(limits, 1);
  const auto run =
      small->renders().Open(Asked(kSurface, R"("width": 8, "height": 8)"), {});
  ASSERT_TRUE(run.ok()) << run.status();
  absl::Status status;
  for (v1::StreamRenderResponse message; status.ok() && !(*run)->Done();) {
    status = (*run)->Next({}, &message);
  }
  EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
}

TEST_F(RenderActorTest, MemoryIsGivenBack) {
  Limits limits;
  limits.render_bytes = 6'000'000;  // one picture's
  const std::unique_ptr<Actor> small = MakeActor(limits, 1);
  const auto request =
      Asked(kSurface, R"("width": 8, "height": 8, "passes": 1)");
  for (int k = 0; k < 3; ++k) {
    const auto run = small->renders().Open(request, {});
    ASSERT_TRUE(run.ok()) << run.status();
    for (v1::StreamRenderResponse message; !(*run)->Done();) {
      const absl::Status status = (*run)->Next({}, &message);
      ASSERT_TRUE(status.ok()) << status;
    }
  }
}

TEST_F(RenderActorTest, StopsWhenAsked) {
  const auto run = actor_->renders().Open(
      Asked(kSurface, R"("width": 800, "height": 600)"), {});
  ASSERT_TRUE(run.ok());
  std::stop_source stop;
  v1::StreamRenderResponse message;
  while (!message.has_band()) {
    ASSERT_TRUE((*run)->Next(stop.get_token(), &message).ok());
  }
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled((*run)->Next(stop.get_token(), &message)));
}

// Once it was asked to stop, no scene is made, but all is checked all the same.
TEST_F(RenderActorTest, EverythingIsCheckedBeforeASceneIsMade) {
  std::stop_source stop;
  stop.request_stop();
  const auto open = [&](const std::string& subject, const std::string& more) {
    return actor_->renders()
        .Open(Asked(subject, more), stop.get_token())
        .status();
  };
  const auto terrain = [](const std::string& width) {
    return R"("terrain": {"terrain": {"recipe": {"seed": "99"}},
              "window": {"height": "5000", "width": ")" +
           width + "\"}}";
  };
  const std::string valid = R"("width": 8)";
  EXPECT_TRUE(absl::IsCancelled(open(terrain("9"), valid)));
  EXPECT_TRUE(absl::IsInvalidArgument(open(terrain("9"), R"("width": -1)")));
  EXPECT_TRUE(absl::IsInvalidArgument(open(terrain("1"), valid)));
  EXPECT_TRUE(absl::IsResourceExhausted(open(terrain("5000"), valid)));
  const auto flower = [](const std::string& plants) {
    return R"("flower": {"flower": {"preset": "flower/daisy", "plants": )" +
           plants + "}}";
  };
  EXPECT_TRUE(absl::IsCancelled(open(flower("1"), valid)));
  EXPECT_TRUE(absl::IsInvalidArgument(open(flower("1"), R"("width": -1)")));
  EXPECT_TRUE(absl::IsResourceExhausted(open(flower("100000"), valid)));
}

TEST_F(RenderActorTest, UnknownPresetsHideNoViolation) {
  EXPECT_THAT(FieldsOf(Asked(R"("tree": {"tree": {"preset": "tree/none"},
                                "tubes": {"sides": 2}})",
                             R"("width": -1)")),
              ElementsAre("width", "tree.tubes.sides"));
  EXPECT_THAT(FieldsOf(Asked(R"("terrain": {"terrain": {"preset": "none"},
                                "window": {"width": 9, "height": -9}})",
                             R"("passes": -1)")),
              ElementsAre("passes", "terrain.window.height"));
  // How many bands there are is not known.
  EXPECT_THAT(FieldsOf(Asked(kSurface, R"("passes": -1, "firstBand": "99")")),
              ElementsAre("passes"));
}

TEST_F(RenderActorTest, UnknownPresetsAreNotFound) {
  EXPECT_TRUE(absl::IsNotFound(
      actor_->renders()
          .Open(Asked(R"("tree": {"tree": {"preset": "tree/none"}})",
                      R"("seed": 1)"),
                {})
          .status()));
}

TEST_F(RenderActorTest, AFlowerIsDrawnWithItsBedAndNamesItsFields) {
  const std::string size = R"("width": 60, "height": 60, "passes": 2,
                              "finalOnly": true)";
  const auto drawn = [&](const std::string& more) {
    const auto messages = Run(
        Asked(R"("flower": {"flower": {"preset": "flower/daisy")" + more + "}}",
              size));
    EXPECT_FALSE(messages.empty());
    return messages;
  };
  const auto one = drawn("");
  EXPECT_EQ(PixelsOf(one, 2).size(), 60u * 60 * 3);
  // Not a picture of the ground and the sky alone.
  EXPECT_NE(PixelsOf(one, 2), PixelsOf(drawn(R"(, "stage": 0)"), 2));
  EXPECT_NE(one.front().header().recipe_hash(),
            drawn(R"(, "plants": 4)").front().header().recipe_hash());
  EXPECT_THAT(FieldsOf(Asked(R"("flower": {"flower": {"preset":
                  "flower/daisy", "stage": 2}})",
                             size)),
              ElementsAre("flower.flower.preset.stage"));
  EXPECT_THAT(FieldsOf(Asked(R"("flower": {})", size)),
              ElementsAre("flower.flower"));
  v1::EstimateRenderRequest ask;
  *ask.mutable_request() =
      Asked(R"("flower": {"flower": {"preset": "flower/rose"}})", size);
  const auto estimate = actor_->renders().Estimate(ask, {});
  ASSERT_TRUE(estimate.ok()) << estimate.status();
  EXPECT_GT(estimate->triangles_most(), 1000);
}

TEST_F(RenderActorTest, ALeafsShapeIsChecked) {
  EXPECT_THAT(FieldsOf(Asked(R"("tree": {"tree": {"recipe": {"leaves": {}}},
          "leafShape": {"width": 3, "blades": 99, "spreadDeg": -1}})",
                             R"("width": 20, "height": 20)")),
              ElementsAre("tree.leaf_shape.width", "tree.leaf_shape.blades",
                          "tree.leaf_shape.spread_deg"));
}

}  // namespace
}  // namespace terrane::server
