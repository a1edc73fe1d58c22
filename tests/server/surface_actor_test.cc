// Surfaces through the Actor: headers, tiles, heights, estimates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "server/actor/actor.h"
#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::HasSubstr;

class SurfaceActorTest : public ::testing::Test {
 protected:
  std::shared_ptr<const SurfaceJob> Open(const std::string& json) {
    auto job =
        actor_->surfaces().Open(FromJson<v1::StreamSurfaceRequest>(json));
    EXPECT_TRUE(job.ok()) << job.status();
    return *std::move(job);
  }
  std::string Error(const std::string& json) {
    return std::string(actor_->surfaces()
                           .Open(FromJson<v1::StreamSurfaceRequest>(json))
                           .status()
                           .message());
  }
  static v1::StreamSurfaceResponse Tile(const SurfaceJob& job,
                                        std::int64_t index) {
    v1::StreamSurfaceResponse message;
    EXPECT_TRUE(job.MakeTile(index, {}, &message).ok());
    return message;
  }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 1);
};

float FloatAt(const std::string& bytes, std::size_t index) {
  float value = 0;
  std::memcpy(&value, bytes.data() + index * sizeof(float), sizeof(float));
  return value;
}

TEST_F(SurfaceActorTest, MeshTilesAreThoseOfTheWhole) {
  const auto whole = Open(R"({"surface": {"preset": "surface/fig07"},
    "columns": 70, "rows": 50, "tileSize": 100, "uvs": true})");
  const v1::MeshTile all = Tile(*whole, 0).mesh_tile();
  EXPECT_EQ(all.total(), 1);
  EXPECT_EQ(all.positions().size(), 70u * 50 * 12);
  EXPECT_EQ(all.normals().size(), 70u * 50 * 12);
  EXPECT_EQ(all.uvs().size(), 70u * 50 * 8);
  const std::string columns = all.positions() + all.normals() + all.uvs();
  EXPECT_EQ(all.checksum(), XXH3_64bits(columns.data(), columns.size()));

  const auto tiled = Open(R"({"surface": {"preset": "surface/fig07"},
    "columns": 70, "rows": 50, "tileSize": 32})");
  EXPECT_EQ(tiled->header().recipe_hash(), whole->header().recipe_hash());
  EXPECT_EQ(tiled->header().tile_columns(), 3);
  EXPECT_EQ(tiled->total(), 6);
  for (std::int64_t k = 0; k < tiled->total(); ++k) {
    const v1::MeshTile tile = Tile(*tiled, k).mesh_tile();
    EXPECT_EQ(tile.index(), k);
    EXPECT_TRUE(tile.uvs().empty());
    const v1::Window& window = tile.window();
    for (std::int64_t j = 0; j < window.height(); ++j) {
      const auto from =
          static_cast<std::size_t>(12 * ((window.y() + j) * 70 + window.x()));
      const auto to = static_cast<std::size_t>(12 * j * window.width());
      const auto size = static_cast<std::size_t>(12 * window.width());
      EXPECT_EQ(tile.positions().compare(to, size, all.positions(), from, size),
                0);
      EXPECT_EQ(tile.normals().compare(to, size, all.normals(), from, size), 0);
    }
  }
}

TEST_F(SurfaceActorTest, AskingWithTheResolvedRecipeGivesTheSame) {
  const auto preset = Open(R"({"surface": {"preset": "surface/fig10",
    "seed": 77}, "columns": 33, "rows": 33})");
  EXPECT_EQ(preset->header().recipe().seed(), 77);
  v1::StreamSurfaceRequest request;
  *request.mutable_surface()->mutable_recipe() = preset->header().recipe();
  request.set_columns(33);
  request.set_rows(33);
  const auto again = *actor_->surfaces().Open(request);
  EXPECT_EQ(again->header().recipe_hash(), preset->header().recipe_hash());
  EXPECT_EQ(Tile(*again, 0).mesh_tile().checksum(),
            Tile(*preset, 0).mesh_tile().checksum());
}

TEST_F(SurfaceActorTest, HeightTilesAreLikeTheTerrains) {
  const auto job = Open(R"({"surface": {"preset": "surface/fig02"},
    "columns": 61, "rows": 31, "tileSize": 40,
    "output": "SURFACE_OUTPUT_HEIGHTS"})");
  const v1::SurfaceHeader& header = job->header();
  EXPECT_EQ(header.encoding(), v1::HEIGHT_ENCODING_FLOAT32_LE);
  EXPECT_DOUBLE_EQ(header.frame().spacing_x(), 0.5);
  EXPECT_DOUBLE_EQ(header.frame().spacing_y(), 1);
  const v1::HeightTile tile = Tile(*job, 1).height_tile();
  EXPECT_EQ(tile.window().x(), 40);
  EXPECT_EQ(tile.window().width(), 21);
  EXPECT_EQ(tile.data().size(), 21u * 31 * 4);
  EXPECT_EQ(tile.checksum(),
            XXH3_64bits(tile.data().data(), tile.data().size()));
  // The net is even, so the raster is the mesh.
  const auto mesh = Open(R"({"surface": {"preset": "surface/fig02"},
    "columns": 61, "rows": 31, "tileSize": 40})");
  const v1::MeshTile vertices = Tile(*mesh, 1).mesh_tile();
  for (std::size_t k = 0; k < 21 * 31; ++k) {
    ASSERT_NEAR(FloatAt(tile.data(), k),
                FloatAt(vertices.positions(), 3 * k + 2), 1e-4);
  }
}

TEST_F(SurfaceActorTest, SixteenBitHeightsKeepToTheRangeAsked) {
  const auto job = Open(R"({"surface": {"preset": "surface/fig01"},
    "columns": 33, "rows": 33, "output": "SURFACE_OUTPUT_HEIGHTS",
    "encoding": "HEIGHT_ENCODING_UINT16_LE",
    "range": {"minimum": -50, "maximum": 50}})");
  EXPECT_EQ(job->header().range().maximum(), 50);
  EXPECT_EQ(Tile(*job, 0).height_tile().data().size(), 33u * 33 * 2);
}

TEST_F(SurfaceActorTest, HolesAreCounted) {
  const auto job = Open(R"({"surface": {"preset": "surface/fig12"},
    "columns": 65, "rows": 65})");
  const v1::MeshTile tile = Tile(*job, 0).mesh_tile();
  EXPECT_GT(tile.left_out_samples(), 0);
  EXPECT_LT(tile.left_out_samples(), 65 * 65 / 2);
}

TEST_F(SurfaceActorTest, EstimatesCountTheTilesThatAreLeft) {
  v1::EstimateSurfaceRequest request;
  *request.mutable_request() = FromJson<v1::StreamSurfaceRequest>(R"({
    "surface": {"preset": "surface/fig08"}, "columns": 300, "rows": 200,
    "tileSize": 100, "firstTile": 1, "uvs": true})");
  const auto estimate = actor_->surfaces().Estimate(request);
  ASSERT_TRUE(estimate.ok()) << estimate.status();
  EXPECT_EQ(estimate->tiles(), 5);
  EXPECT_EQ(estimate->samples(), 50'000);
  EXPECT_EQ(estimate->data_bytes(), 50'000 * 32);
  // Carried over: tiles of the three columns take 100, 200 and 300 columns.
  EXPECT_EQ(estimate->generated_samples(), (100 + 2 * 200 + 2 * 300) * 100);
}

TEST_F(SurfaceActorTest, ErrorsNameTheField) {
  EXPECT_THAT(Error(R"({"columns": 9, "rows": 9})"),
              HasSubstr("surface: must hold a recipe or a preset"));
  EXPECT_THAT(Error(R"({"surface": {"preset": "surface/none"},
                        "columns": 9, "rows": 9})"),
              HasSubstr("no preset is called \"surface/none\""));
  EXPECT_EQ(Error(R"({"surface": {"preset": "surface/none"}, "columns": 9,
                      "rows": 9, "firstTile": -1})"),
            "first_tile: must be in [0, 1], got -1");
  EXPECT_THAT(Error(R"({"surface": {"recipe": {}}, "columns": 9, "rows": 9})"),
              HasSubstr("surface.recipe.net.columns: must be in [2, 64]"));
  EXPECT_THAT(Error(R"({"surface": {"recipe": {"net": {
      "columns": 2, "rows": 2, "basis": "SPLINE_BASIS_BILINEAR",
      "points": [{"x": 1}, {}, {"x": 1, "y": 1}, {"y": 1}]}}},
      "columns": 9, "rows": 9, "output": "SURFACE_OUTPUT_HEIGHTS"})"),
              HasSubstr("surface.recipe.net.points: fold over"));
}

}  // namespace
}  // namespace terrane::server
