#include "client/export_shard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "client/local_backend.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using testing::HasSubstr;

// A service whose servers are being replaced: what the first stream brings is
// of the job, what the others bring is as `change` makes it.
class MidRollout : public LocalBackend {
 public:
  explicit MidRollout(void (*change)(v1::StreamHeader*))
      : LocalBackend(1), change_(change) {}

  absl::Status StreamTiles(const v1::StreamTilesRequest& request,
                           const OnHeader& on_header, const OnTile& on_tile,
                           std::stop_token stop) override {
    const bool first = streams_++ == 0;
    return LocalBackend::StreamTiles(
        request,
        [&](v1::StreamHeader header) {
          if (!first) change_(&header);
          return on_header(header);
        },
        on_tile, stop);
  }

 private:
  void (*const change_)(v1::StreamHeader*);
  int streams_ = 0;
};

// The first of two shards of nine tiles: a row of three, and two below it.
class ExportShardTest : public ::testing::Test {
 protected:
  ExportShardTest() {
    request_.mutable_terrain()->mutable_recipe()->set_seed(5);
    request_.set_level(4);
    request_.set_tile_size(9);
    request_.mutable_tiles()->set_columns(3);
    request_.mutable_tiles()->set_rows(3);
    v1::PrepareTerrainRequest prepare;
    *prepare.mutable_terrain() = request_.terrain();
    const v1::PreparedTerrain prepared =
        LocalBackend(1).PrepareTerrain(prepare, nullptr, {}).value();
    job_.set_recipe_hash(prepared.recipe_hash());
    job_.set_revision(prepared.revision());
    job_.set_tile_columns(3);
    job_.set_tile_rows(3);
    job_.set_file("tile.f32");
    job_.set_shards(2);
  }

  ExportShard Shard() const {
    return ExportShard(folder_.File("tile.f32"), job_, 0, request_, {});
  }
  int TilesInManifest() const {
    return ReadManifest(folder_.File("tile.f32.shard-0-of-2.json"))
        .value()
        .tiles_size();
  }
  // What comes of an export from `backend`; the tiles before the change stay.
  std::string ErrorOf(MidRollout backend) {
    ExportShard shard = Shard();
    const absl::Status status = shard.Run(ProgressMode::kNone, &backend, {});
    EXPECT_TRUE(absl::IsFailedPrecondition(status)) << status;
    EXPECT_EQ(TilesInManifest(), 3);
    EXPECT_FALSE(std::filesystem::exists(folder_.File("tile_x0_y1.f32")));
    return std::string(status.message());
  }

  const TemporaryFolder folder_;
  v1::StreamTilesRequest request_;
  ExportJob job_;
};

TEST_F(ExportShardTest, TilesOfAnotherRevisionAreNotTaken) {
  const auto next = static_cast<int>(job_.revision()) + 1;
  const std::string error = ErrorOf(MidRollout([](v1::StreamHeader* header) {
    header->set_revision(header->revision() + 1);
  }));
  EXPECT_THAT(error, HasSubstr("at revision " + std::to_string(next) + ","));
  EXPECT_TRUE(error.ends_with("at revision " + std::to_string(next - 1)));
}

TEST_F(ExportShardTest, TilesOfAnotherRecipeAreNotTaken) {
  const std::string error = ErrorOf(MidRollout(
      [](v1::StreamHeader* header) { header->set_recipe_hash("sha256:new"); }));
  EXPECT_THAT(error, HasSubstr("are of recipe sha256:new"));
  EXPECT_THAT(error, HasSubstr("of recipe " + job_.recipe_hash()));
}

TEST_F(ExportShardTest, AnInterruptWhileHashingCostsNoTile) {
  LocalBackend backend(1);
  EXPECT_TRUE(Shard().Run(ProgressMode::kNone, &backend, {}).ok());
  ASSERT_EQ(TilesInManifest(), 5);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled(
      Shard().Run(ProgressMode::kNone, &backend, stop.get_token())));
  EXPECT_EQ(TilesInManifest(), 5);
}

TEST(WaitAfterSave, GrowsWithWhatAManifestCosts) {
  using std::chrono::milliseconds;
  EXPECT_EQ(WaitAfterSave(milliseconds(0)), milliseconds(1000));
  EXPECT_EQ(WaitAfterSave(milliseconds(50)), milliseconds(1000));
  EXPECT_EQ(WaitAfterSave(milliseconds(51)), milliseconds(1020));
  EXPECT_EQ(WaitAfterSave(milliseconds(2000)), milliseconds(40000));
}

}  // namespace
}  // namespace terrane::client
