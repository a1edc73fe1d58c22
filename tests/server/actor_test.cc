// The whole service without a network: presets, rasters, tiles, profiles,
// heights, estimates and what is refused.
#include "server/actor/actor.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "core/base/violations.h"
#include "core/grid/height_codec.h"
#include "server/actor/presets.h"
#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::HasSubstr;

class ActorTest : public ::testing::Test {
 protected:
  std::shared_ptr<const TileJob> Open(const std::string& json) {
    auto job = actor_->OpenTiles(FromJson<v1::StreamTilesRequest>(json), {});
    EXPECT_TRUE(job.ok()) << job.status();
    return job.ok() ? *std::move(job) : nullptr;
  }
  absl::Status OpenError(const std::string& json) {
    return actor_->OpenTiles(FromJson<v1::StreamTilesRequest>(json), {})
        .status();
  }
  v1::HeightTile Make(const TileJob& job, std::int64_t index) {
    v1::HeightTile tile;
    const absl::Status status = job.MakeTile(index, {}, &scratch_, &tile);
    EXPECT_TRUE(status.ok()) << status;
    return tile;
  }
  // The heights of a FLOAT32_LE tile.
  std::vector<float> Heights(const v1::HeightTile& tile) {
    std::vector<float> heights(tile.data().size() / sizeof(float));
    std::memcpy(heights.data(), tile.data().data(), tile.data().size());
    return heights;
  }
  // Uploads a rough 16 x 13 model with posts 30 apart; its id.
  std::string UploadModel() {
    const auto upload = actor_->BeginRasterUpload();
    EXPECT_TRUE(upload
                    ->Add(FromJson<v1::UploadRasterRequest>(
                        R"({"header": {"width": "16", "height": "13", "frame":
                            {"originX": 500, "originY": 900, "spacingX": 30,
                             "spacingY": -30, "crs": "EPSG:32617"}}})"))
                    .ok());
    v1::UploadRasterRequest chunk;
    for (int i = 0; i < 16 * 13; ++i) {
      const float height = static_cast<float>((i * 37) % 23);
      chunk.mutable_chunk()->append(reinterpret_cast<const char*>(&height),
                                    sizeof height);
    }
    EXPECT_TRUE(upload->Add(chunk).ok());
    const auto response = upload->Finish();
    EXPECT_TRUE(response.ok()) << response.status();
    return response.ok() ? response->raster_id() : "";
  }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 3);
  core::TileScratch scratch_;
};

TEST_F(ActorTest, TilesAreThePiecesOfTheWhole) {
  const auto whole = Open(R"({"terrain": {"preset": "demo/hills"}, "level": 5,
    "tileSize": 100, "window": {"x": -50, "y": 7, "width": 100, "height": 60}})");
  const auto cut = Open(R"({"terrain": {"preset": "demo/hills"}, "level": 5,
    "tileSize": 32, "window": {"x": -50, "y": 7, "width": 100, "height": 60}})");
  ASSERT_EQ(whole->total(), 1);
  ASSERT_EQ(cut->total(), 8);
  const std::vector<float> expected = Heights(Make(*whole, 0));
  for (std::int64_t index = 0; index < cut->total(); ++index) {
    const v1::HeightTile tile = Make(*cut, index);
    EXPECT_EQ(tile.index(), index);
    EXPECT_EQ(tile.tile_x(), index % 4);
    EXPECT_EQ(tile.tile_y(), index / 4);
    const std::vector<float> heights = Heights(tile);
    const v1::Window& window = tile.window();
    ASSERT_EQ(heights.size(),
              static_cast<std::size_t>(window.width() * window.height()));
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const std::int64_t at = static_cast<std::int64_t>(i);
      const std::int64_t x = window.x() + at % window.width() + 50;
      const std::int64_t y = window.y() + at / window.width() - 7;
      ASSERT_EQ(heights[i], expected[static_cast<std::size_t>(y * 100 + x)]);
    }
  }
}

TEST_F(ActorTest, TileDescribesItsData) {
  const auto job = Open(R"({"terrain": {"preset": "demo/hills"}, "level": 5,
    "tileSize": 33, "tiles": {"x": -1, "y": 2, "columns": 2, "rows": 1}})");
  const v1::HeightTile tile = Make(*job, 1);
  EXPECT_EQ(tile.total(), 2);
  EXPECT_EQ(tile.tile_x(), 0);
  EXPECT_EQ(tile.tile_y(), 2);
  EXPECT_EQ(tile.window().x(), 0);
  EXPECT_EQ(tile.window().y(), 64);
  EXPECT_EQ(tile.level(), 5);
  EXPECT_EQ(tile.sampling(), v1::SAMPLING_POINT);
  EXPECT_EQ(tile.encoding(), v1::HEIGHT_ENCODING_FLOAT32_LE);
  const std::vector<float> heights = Heights(tile);
  EXPECT_EQ(tile.minimum(), *std::min_element(heights.begin(), heights.end()));
  EXPECT_EQ(tile.maximum(), *std::max_element(heights.begin(), heights.end()));
  EXPECT_LT(tile.minimum(), tile.maximum());
  EXPECT_EQ(tile.checksum(),
            XXH3_64bits(tile.data().data(), tile.data().size()));
}

// A message that is used again holds nothing of the tile before.
TEST_F(ActorTest, TilesMayBeMadeIntoTheSameMessage) {
  const auto job = Open(R"({"terrain": {"preset": "demo/hills"}, "level": 5,
    "tileSize": 40, "window": {"width": 70, "height": 50}})");
  v1::HeightTile reused;
  for (const std::int64_t index : {0, 3, 1, 0, 2}) {
    ASSERT_TRUE(job->MakeTile(index, {}, &scratch_, &reused).ok());
    EXPECT_EQ(reused.SerializeAsString(),
              Make(*job, index).SerializeAsString());
  }
}

TEST_F(ActorTest, SixteenBitsHoldTheSameHeights) {
  const std::string extent = R"("terrain": {"preset": "demo/hills"},
    "level": 5, "tileSize": 64, "window": {"width": 64, "height": 64})";
  const std::vector<float> heights =
      Heights(Make(*Open("{" + extent + "}"), 0));
  const auto job =
      Open("{" + extent + R"(, "encoding": "HEIGHT_ENCODING_UINT16_LE"})");
  const double minimum = job->header().range().minimum();
  const double maximum = job->header().range().maximum();
  const v1::HeightTile tile = Make(*job, 0);
  ASSERT_EQ(tile.data().size(), 2 * heights.size());
  EXPECT_EQ(tile.clipped_samples(), 0);
  const double step = (maximum - minimum) / 65535;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    std::uint16_t value = 0;
    std::memcpy(&value, tile.data().data() + 2 * i, sizeof value);
    EXPECT_NEAR(core::DecodeUint16(value, minimum, maximum), heights[i],
                0.52 * step);
  }
}

TEST_F(ActorTest, HeightsOutsideTheRangeAreCutAndCounted) {
  const auto job = Open(R"({"terrain": {"preset": "demo/hills"}, "level": 5,
    "tileSize": 64, "window": {"width": 64, "height": 64},
    "encoding": "HEIGHT_ENCODING_UINT16_LE",
    "range": {"minimum": -9000, "maximum": -8000}})");
  const v1::HeightTile tile = Make(*job, 0);
  EXPECT_EQ(tile.clipped_samples(), 64 * 64);
  EXPECT_EQ(tile.data(), std::string(2 * 64 * 64, '\xff'));
}

TEST_F(ActorTest, RecipeAndPresetOfTheSameTerrainHashAlike) {
  v1::StreamTilesRequest by_recipe = FromJson<v1::StreamTilesRequest>(
      R"({"window": {"width": 1, "height": 1}})");
  *by_recipe.mutable_terrain()->mutable_recipe() =
      FindPreset("demo/hills").value()->recipe();
  const auto from_recipe = actor_->OpenTiles(by_recipe, {});
  ASSERT_TRUE(from_recipe.ok());
  const auto from_preset = Open(R"({"terrain": {"preset": "demo/hills"},
    "window": {"width": 1, "height": 1}})");
  EXPECT_EQ((*from_recipe)->header().recipe_hash(),
            from_preset->header().recipe_hash());
  const auto other = Open(R"({"terrain": {"preset": "demo/hills", "seed": 5},
    "window": {"width": 1, "height": 1}})");
  EXPECT_NE(other->header().recipe_hash(), from_preset->header().recipe_hash());
  EXPECT_EQ(other->header().recipe().seed(), 5);
}

TEST_F(ActorTest, ResolvedRecipeGivesTheSameBytes) {
  const std::string id = UploadModel();
  const auto job = Open(R"({"terrain": {"recipe": {"refinement": {}, "macro":
    {"parts": [{"raster": {"rasterId": ")" +
                        id + R"("}}]}}}, "level": 2})");
  ASSERT_NE(job, nullptr);
  EXPECT_EQ(job->header().frame().crs(), "EPSG:32617");
  EXPECT_TRUE(job->header().recipe().has_roughness());
  EXPECT_TRUE(job->header().recipe().has_fidelity());
  EXPECT_EQ(job->header().window().width(), 61);
  EXPECT_EQ(job->header().window().height(), 49);
  v1::StreamTilesRequest again;
  *again.mutable_terrain()->mutable_recipe() = job->header().recipe();
  again.set_level(2);
  const auto resolved = actor_->OpenTiles(again, {});
  ASSERT_TRUE(resolved.ok()) << resolved.status();
  EXPECT_EQ((*resolved)->header().SerializeAsString(),
            job->header().SerializeAsString());
  EXPECT_EQ(Make(**resolved, 0).data(), Make(*job, 0).data());
  // Refining keeps every post.
  const std::vector<float> heights = Heights(Make(*job, 0));
  for (int j = 0; j < 13; ++j) {
    for (int i = 0; i < 16; ++i) {
      EXPECT_EQ(heights[static_cast<std::size_t>(4 * j * 61 + 4 * i)],
                static_cast<float>(((j * 16 + i) * 37) % 23));
    }
  }
}

TEST_F(ActorTest, ACheckedWindowIsWhatOpens) {
  const std::string terrain = R"("terrain": {"recipe": {"domain": {"cellsX":
    "4", "cellsY": "3"}, "spots": {"level": 0, "points":
    [{"x": 2, "y": 3, "height": 4}]}}})";
  const auto request =
      FromJson<v1::StreamTilesRequest>("{" + terrain + R"(, "level": 2})");
  const auto window = actor_->CheckTiles(request);
  ASSERT_TRUE(window.ok()) << window.status();
  EXPECT_EQ(window->width(), 17);
  EXPECT_EQ(window->height(), 13);
  EXPECT_EQ(
      (*actor_->OpenTiles(request, {}))->header().window().SerializeAsString(),
      window->SerializeAsString());
  EXPECT_THAT(
      core::ViolationsOf(
          actor_->CheckTiles(FromJson<v1::StreamTilesRequest>("{}")).status()),
      testing::SizeIs(1));
}

TEST_F(ActorTest, EstimateIsWhatTheStreamSends) {
  v1::EstimateTilesRequest request;
  *request.mutable_request() = FromJson<v1::StreamTilesRequest>(
      R"({"terrain": {"preset": "demo/hills"}, "level": 5, "tileSize": 32,
          "firstTile": 5, "window": {"width": 100, "height": 70}})");
  const auto estimate = actor_->EstimateTiles(request, {});
  ASSERT_TRUE(estimate.ok()) << estimate.status();
  const auto job = *actor_->OpenTiles(request.request(), {});
  std::int64_t bytes = 0;
  for (std::int64_t i = job->first(); i < job->total(); ++i) {
    bytes += static_cast<std::int64_t>(Make(*job, i).data().size());
  }
  EXPECT_EQ(estimate->tiles(), job->total() - 5);
  EXPECT_EQ(estimate->data_bytes(), bytes);
  EXPECT_EQ(estimate->samples(), bytes / 4);
  EXPECT_GT(estimate->generated_points(), estimate->samples());
  EXPECT_GT(estimate->cpu_seconds(), 0);
  EXPECT_GT(estimate->memory_bytes(), 0);
}

TEST_F(ActorTest, ProfileHasHeightsAndMacroShape) {
  const auto profile = actor_->GetProfile(
      FromJson<v1::GetProfileRequest>(
          R"({"level": 3, "terrain": {"recipe": {"dimensions": 1,
              "fidelity": 0, "domain": {"cellsX": "4"},
              "frame": {"originX": 10, "spacingX": 2},
              "macro": {"parts": [{"profile":
                {"x": [10, 18], "heights": [0, 8]}}]}}}})"),
      {});
  ASSERT_TRUE(profile.ok()) << profile.status();
  ASSERT_EQ(profile->heights_size(), 33);
  ASSERT_EQ(profile->macro_heights_size(), 33);
  EXPECT_EQ(profile->first_x(), 10);
  EXPECT_EQ(profile->step_x(), 0.25);
  for (int i = 0; i < 33; ++i) {
    EXPECT_NEAR(profile->macro_heights(i), 0.25 * i, 1e-6);
    EXPECT_EQ(profile->heights(i), profile->macro_heights(i));  // T = 0
  }
}

TEST_F(ActorTest, HeightsAtLatticePointsAreTheirSamples) {
  const auto job = Open(R"({"terrain": {"preset": "demo/hills"}, "level": 4,
    "window": {"width": 8, "height": 8}})");
  const std::vector<float> samples = Heights(Make(*job, 0));
  v1::GetHeightsRequest request;
  request.mutable_terrain()->set_preset("demo/hills");
  request.set_level(4);
  for (int i = 0; i < 8; ++i) {
    v1::Point* point = request.add_points();
    point->set_x(i * 2048.0 / 16);
    point->set_y(i * -2048.0 / 16);
  }
  const auto heights = actor_->GetHeights(request, {});
  ASSERT_TRUE(heights.ok()) << heights.status();
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(heights->heights(i), samples[static_cast<std::size_t>(9 * i)]);
  }
}

TEST_F(ActorTest, CancelledWorkSaysSo) {
  const auto job = Open(R"({"terrain": {"preset": "demo/hills"}, "level": 20,
    "tileSize": 1025, "window": {"width": 1025, "height": 1025}})");
  std::stop_source stop;
  stop.request_stop();
  v1::HeightTile tile;
  EXPECT_EQ(job->MakeTile(0, stop.get_token(), &scratch_, &tile).code(),
            absl::StatusCode::kCancelled);
  EXPECT_EQ(job->MakeTile(1, {}, &scratch_, &tile).code(),
            absl::StatusCode::kOutOfRange);
}

// 9 x 9 posts 1 apart; level 3 has 65 x 65 samples 1/8 apart.
constexpr char kSpots[] = R"("domain": {"cellsX": "8", "cellsY": "8"},
  "spots": {"level": 3, "points": [{"x": 2, "y": 3, "height": 40.1},
    {"x": 5.125, "y": 7.875, "height": -7}, {"x": 6.06, "y": 1, "height": 9}]})";

TEST_F(ActorTest, SpotsAreMetAndReported) {
  const auto job = Open(std::string(R"({"terrain": {"recipe": {)") + kSpots +
                        R"(}}, "level": 3})");
  ASSERT_NE(job, nullptr);
  EXPECT_EQ(job->header().spots().spots(), 3);
  EXPECT_EQ(job->header().spots().level(), 3);
  EXPECT_NEAR(job->header().spots().largest_move(), 0.06, 1e-12);
  const std::vector<float> heights = Heights(Make(*job, 0));
  EXPECT_EQ(heights[24 * 65 + 16], 40.1F);
  EXPECT_EQ(heights[63 * 65 + 41], -7.0F);
  EXPECT_EQ(heights[8 * 65 + 48], 9.0F);
}

TEST_F(ActorTest, ResolvedSpotsGiveTheSameBytes) {
  const auto job = Open(R"({"terrain": {"recipe": {"spots": {"points":
    [{"x": 2, "y": 3.25, "height": 4}]}}}, "level": 4,
    "window": {"width": 70, "height": 70}})");
  ASSERT_NE(job, nullptr);
  // The coarsest level that holds the spot.
  EXPECT_EQ(job->header().recipe().spots().level(), 2);
  v1::StreamTilesRequest again = FromJson<v1::StreamTilesRequest>(
      R"({"level": 4, "window": {"width": 70, "height": 70}})");
  *again.mutable_terrain()->mutable_recipe() = job->header().recipe();
  const auto resolved = actor_->OpenTiles(again, {});
  ASSERT_TRUE(resolved.ok()) << resolved.status();
  EXPECT_EQ((*resolved)->header().SerializeAsString(),
            job->header().SerializeAsString());
  EXPECT_EQ(Make(**resolved, 0).data(), Make(*job, 0).data());
}

TEST_F(ActorTest, PreparationTellsWhatItMade) {
  const auto request = FromJson<v1::PrepareTerrainRequest>(
      std::string(R"({"terrain": {"recipe": {)") + kSpots + "}}}");
  double last = 0;
  const auto prepared = actor_->PrepareTerrain(request,
                                               [&](double fraction) {
                                                 EXPECT_GE(fraction, last);
                                                 last = fraction;
                                               },
                                               {});
  ASSERT_TRUE(prepared.ok()) << prepared.status();
  EXPECT_GT(prepared->memory_bytes(), 0);
  EXPECT_EQ(prepared->revision(), core::kTerrainRevision);
  v1::StreamTilesRequest tiles;
  *tiles.mutable_terrain() = request.terrain();
  const auto job = *actor_->OpenTiles(tiles, {});
  EXPECT_EQ(job->header().recipe_hash(), prepared->recipe_hash());
  EXPECT_EQ(job->header().recipe().SerializeAsString(),
            prepared->recipe().SerializeAsString());
  EXPECT_EQ(job->header().spots().SerializeAsString(),
            prepared->spots().SerializeAsString());
}

TEST_F(ActorTest, PreparationThatTakesTooMuchIsRefusedBeforeWork) {
  Limits limits;
  limits.prepared_bytes = 100;
  const auto actor = MakeActor(limits, 1);
  const auto request = FromJson<v1::PrepareTerrainRequest>(
      std::string(R"({"terrain": {"recipe": {)") + kSpots + "}}}");
  const absl::Status refused = actor->PrepareTerrain(request, {}, {}).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("gives 100"));
  // The price is answered all the same.
  v1::EstimateTilesRequest estimate;
  *estimate.mutable_request()->mutable_terrain() = request.terrain();
  const auto price = actor->EstimateTiles(estimate, {});
  ASSERT_TRUE(price.ok()) << price.status();
  EXPECT_GT(price->prepare_bytes(), 100);
  EXPECT_GT(price->prepare_seconds(), 0);
}

TEST_F(ActorTest, SpotsThatContradictAreNamedByTheRequestsPath) {
  const auto violations = core::ViolationsOf(
      OpenError(R"({"terrain": {"recipe": {"spots": {"level": 0, "points":
        [{"x": 2.1, "y": 3, "height": 4}, {"x": 1.9, "y": 3, "height": 5}]}}},
        "window": {"width": 4, "height": 4}})"));
  ASSERT_FALSE(violations.empty());
  EXPECT_EQ(violations[0].field, "terrain.recipe.spots.points[1]");
}

TEST_F(ActorTest, PreparationEndsWhenItsCallerDoes) {
  std::stop_source stop;
  stop.request_stop();
  const auto request = FromJson<v1::PrepareTerrainRequest>(
      std::string(R"({"terrain": {"recipe": {)") + kSpots + "}}}");
  EXPECT_TRUE(absl::IsCancelled(
      actor_->PrepareTerrain(request, {}, stop.get_token()).status()));
  v1::StreamTilesRequest tiles;
  *tiles.mutable_terrain() = request.terrain();
  EXPECT_TRUE(
      absl::IsCancelled(actor_->OpenTiles(tiles, stop.get_token()).status()));
  v1::EstimateTilesRequest estimate;
  *estimate.mutable_request() = tiles;
  EXPECT_TRUE(absl::IsCancelled(
      actor_->EstimateTiles(estimate, stop.get_token()).status()));
  v1::EstimateRenderRequest render;
  *render.mutable_request()->mutable_terrain()->mutable_terrain() =
      request.terrain();
  EXPECT_TRUE(absl::IsCancelled(
      actor_->renders().Estimate(render, stop.get_token()).status()));
}

TEST_F(ActorTest, InfoNamesLimitsAndPresets) {
  const v1::GetServerInfoResponse info = actor_->GetServerInfo();
  EXPECT_EQ(info.workers(), 3);
  EXPECT_EQ(info.terrain_revision(), core::kTerrainRevision);
  EXPECT_EQ(info.limits().max_level(), Limits().max_level);
  EXPECT_EQ(info.limits().raster_store_bytes(), Limits().raster_store_bytes);
  EXPECT_EQ(info.limits().max_spots(), Limits().recipe.max_spots);
  EXPECT_EQ(info.limits().max_inline_spots(), Limits().recipe.max_inline_spots);
  EXPECT_EQ(info.limits().prepared_bytes(), Limits().prepared_bytes);
  std::vector<std::string> names;
  for (const v1::PresetSummary& preset : info.presets()) {
    names.push_back(preset.name());
    EXPECT_NE(preset.title(), "") << preset.name();
  }
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_THAT(names, ::testing::Contains("demo/hills"));
}

TEST_F(ActorTest, EveryPresetCanBeGenerated) {
  for (const auto& [name, preset] : Presets()) {
    v1::TerrainChoice choice;
    choice.set_preset(name);
    if (preset.recipe().dimensions() == 1) {
      v1::GetProfileRequest request;
      *request.mutable_terrain() = choice;
      request.set_count(2);
      const auto profile = actor_->GetProfile(request, {});
      EXPECT_TRUE(profile.ok()) << name << ": " << profile.status();
      continue;
    }
    v1::StreamTilesRequest request;
    *request.mutable_terrain() = choice;
    request.mutable_window()->set_width(2);
    request.mutable_window()->set_height(2);
    const auto job = actor_->OpenTiles(request, {});
    ASSERT_TRUE(job.ok()) << name << ": " << job.status();
    Make(**job, 0);
  }
}

}  // namespace
}  // namespace terrane::server
