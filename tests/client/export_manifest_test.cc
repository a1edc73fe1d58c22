#include "client/export_manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "client/output_file.h"
#include "tests/client/disk_calls.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// One shard of one tile, made.
class ExportManifestTest : public ::testing::Test {
 protected:
  ExportManifestTest() {
    manifest_.mutable_job()->set_file("tile.tif");
    manifest_.mutable_job()->set_tile_columns(1);
    manifest_.mutable_job()->set_tile_rows(1);
    manifest_.mutable_job()->set_shards(1);
    const std::string tile = folder_.File("tile_x0_y0.tif");
    const std::string_view heights = "heights";
    EXPECT_TRUE(WriteFile(tile, std::as_bytes(std::span(heights))).ok());
    *manifest_.add_tiles()->add_files() = DescribeFile(tile).value();
  }

  // Writes the manifest where that of `out` belongs, and verifies.
  absl::StatusOr<std::vector<std::string>> Verify(const std::string& out,
                                                  std::stop_token stop = {}) {
    const std::string path = folder_.File(out);
    EXPECT_TRUE(WriteManifest(ManifestPath(path, 0, 1), manifest_).ok());
    ExportSummary summary;
    return VerifyExport(path, 1, stop, &summary);
  }

  const TemporaryFolder folder_;
  ExportManifest manifest_;
};

TEST_F(ExportManifestTest, ATileThatIsThereIsFine) {
  EXPECT_THAT(Verify("tile.tif").value(), IsEmpty());
}

TEST_F(ExportManifestTest, EveryFormatHasAManifestOfItsOwn) {
  EXPECT_EQ(ManifestPath("world/tile.tif", 3, 8),
            "world/tile.tif.shard-3-of-8.json");
  EXPECT_EQ(ManifestPath("x{x}_y{y}.f32", 0, 1), "xx_yy.f32.shard-0-of-1.json");
}

TEST_F(ExportManifestTest, NamesLastOnceTheManifestIsWritten) {
  const std::string path = folder_.File("manifest.json");
  DiskCalls().clear();
  EXPECT_TRUE(WriteManifest(path, manifest_).ok());
  EXPECT_THAT(
      DiskCalls(),
      ElementsAre(
          StartsWith("fsync " + folder_.File(".manifest.json.")),
          EndsWith(" to " + path),
          "fsync " + std::filesystem::path(path).parent_path().string()));
}

TEST_F(ExportManifestTest, FilesOfAnotherNameAreNotTheseFiles) {
  EXPECT_THAT(
      Verify("tile.f32").value(),
      ElementsAre(HasSubstr("is of tiles of the name tile.tif, not tile.f32")));
  // Their manifests have the same name.
  EXPECT_THAT(
      Verify("{tile}.tif").value(),
      ElementsAre(HasSubstr("is of tiles of the name tile.tif, not {tile}")));
}

TEST_F(ExportManifestTest, AJobWithoutTilesIsNamed) {
  manifest_.mutable_job()->set_tile_rows(0);
  EXPECT_THAT(Verify("tile.tif").value(),
              ElementsAre(HasSubstr("is of a job without tiles")));
}

TEST_F(ExportManifestTest, AnInterruptEndsTheHashing) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled(Verify("tile.tif", stop.get_token()).status()));
}

}  // namespace
}  // namespace terrane::client
