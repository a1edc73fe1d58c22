#include "client/height_sink.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <sys/resource.h>

#include <array>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <limits>

#include "client/gdal_support.h"
#include "client/placed_raster.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr std::int64_t kWidth = 70;
constexpr std::int64_t kHeight = 45;
constexpr std::int64_t kTile = 32;

// Heights with every bit of the mantissa in use.
std::vector<float> SomeHeights() {
  std::vector<float> heights;
  for (int at = 0; at < kWidth * kHeight; ++at) {
    heights.push_back(static_cast<float>(300 + 250 * std::sin(at * 0.37)));
  }
  return heights;
}

HeightLayout SomeLayout(core::Sampling sampling) {
  HeightLayout layout;
  layout.window = {1000, 2000, kWidth, kHeight};
  layout.level = 3;
  layout.sampling = sampling;
  layout.frame = {700000, 4050000, 30, -30};
  layout.crs = "EPSG:32616";
  layout.tile_size = kTile;
  layout.recipe_hash = "sha256:00";
  layout.revision = 1;
  return layout;
}

// Writes tile by tile, as a stream comes.
absl::Status WriteTiles(HeightSink* sink, const std::vector<float>& heights) {
  HeightTotals totals;
  for (std::int64_t y = 0; y < kHeight; y += kTile) {
    for (std::int64_t x = 0; x < kWidth; x += kTile) {
      const core::Window tile{x, y, std::min(kTile, kWidth - x),
                              std::min(kTile, kHeight - y)};
      std::vector<float> part;
      for (std::int64_t j = 0; j < tile.height; ++j) {
        for (std::int64_t i = 0; i < tile.width; ++i) {
          const float height =
              heights[static_cast<std::size_t>((y + j) * kWidth + x + i)];
          part.push_back(height);
          totals.Add(height, height, std::isnan(height) ? 1 : 0);
        }
      }
      const absl::Status status = sink->Write(tile, part);
      if (!status.ok()) return status;
    }
  }
  return sink->Finish(totals);
}

absl::Status WriteAll(const std::string& path, const HeightLayout& layout,
                      const std::vector<float>& heights,
                      const SinkOptions& options = {}) {
  const auto sink = OpenHeightSink(path, layout, options);
  if (!sink.ok()) return sink.status();
  return WriteTiles(sink->get(), heights);
}

std::vector<std::uint32_t> Bits(const std::vector<float>& heights) {
  std::vector<std::uint32_t> bits;
  for (const float height : heights) {
    bits.push_back(std::bit_cast<std::uint32_t>(height));
  }
  return bits;
}

class ExactFormat : public testing::TestWithParam<const char*> {};

TEST_P(ExactFormat, ComesBackBitForBit) {
  const TemporaryFolder folder;
  const std::string path = folder.File(std::string("h") + GetParam());
  const std::vector<float> heights = SomeHeights();
  ASSERT_EQ(WriteAll(path, SomeLayout(core::Sampling::kPoint), heights),
            absl::OkStatus());
  if (std::string(GetParam()) == ".exr") {
    const auto input = OIIO::ImageInput::open(path);
    ASSERT_NE(input, nullptr) << OIIO::geterror();
    ASSERT_EQ(input->spec().nchannels, 1);
    std::vector<float> values(heights.size());
    ASSERT_TRUE(
        input->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, values.data()));
    EXPECT_EQ(Bits(values), Bits(heights));
    return;
  }
  const auto read = ReadHeights(path, {});
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->raster.width, kWidth);
  EXPECT_EQ(read->raster.height, kHeight);
  EXPECT_EQ(Bits(read->raster.values), Bits(heights));
  EXPECT_EQ(read->raster.frame, SomeLayout(core::Sampling::kPoint).frame);
}

INSTANTIATE_TEST_SUITE_P(HeightSink, ExactFormat,
                         testing::Values(".tif", ".f32", ".exr"),
                         [](const auto& one) {
                           return std::string(one.param).substr(1);
                         });

TEST(HeightSink, SixteenBitFormatsComeBackWithinHalfAStepOfOneRange) {
  const TemporaryFolder folder;
  const std::vector<float> heights = SomeHeights();
  const HeightLayout layout = SomeLayout(core::Sampling::kArea);
  ASSERT_EQ(WriteAll(folder.File("h.r16"), layout, heights), absl::OkStatus());
  ASSERT_EQ(WriteAll(folder.File("h.png"), layout, heights), absl::OkStatus());
  const auto raw = ReadHeights(folder.File("h.r16"), {});
  ASSERT_TRUE(raw.ok()) << raw.status();
  const auto png = ReadRaster(folder.File("h.png"), {});
  ASSERT_TRUE(png.ok()) << png.status();

  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double step = (static_cast<double>(*high) - *low) / 65535;
  for (std::size_t at = 0; at < heights.size(); ++at) {
    ASSERT_NEAR(raw->raster.values[at], heights[at], 0.52 * step);
    ASSERT_NEAR(*low + png->raster.values[at] * step, heights[at], 0.52 * step);
  }
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("h.r16", "h.r16.json",
                                                   "h.png", "h.png.json"));
}

TEST(HeightSink, GivenRangeIsKeptAndWhatIsOutsideIsCut) {
  const TemporaryFolder folder;
  SinkOptions options;
  options.range = HeightRange{250, 350};
  std::vector<float> heights = SomeHeights();
  heights[0] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_EQ(WriteAll(folder.File("h.r16"), SomeLayout(core::Sampling::kPoint),
                     heights, options),
            absl::OkStatus());
  const auto read = ReadHeights(folder.File("h.r16"), {});
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->raster.values[0], 250);
  for (std::size_t at = 1; at < heights.size(); ++at) {
    const float expected = std::clamp(heights[at], 250.0F, 350.0F);
    ASSERT_NEAR(read->raster.values[at], expected, 0.52 * 100 / 65535) << at;
  }
}

TEST(HeightSink, PlainHasAUsableRange) {
  const TemporaryFolder folder;
  const std::vector<float> heights(kWidth * kHeight, 12.5F);
  ASSERT_EQ(WriteAll(folder.File("h.r16"), SomeLayout(core::Sampling::kPoint),
                     heights),
            absl::OkStatus());
  const auto read = ReadHeights(folder.File("h.r16"), {});
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_THAT(read->raster.values, testing::Each(12.5F));
}

// What other programs see of the place: GDAL's corner-based transform is half a
// sample off the first post in both samplings, AREA_OR_POINT tells them apart.
TEST(HeightSink, GeoTiffIsPlacedAndNamesItsSampling) {
  for (const auto& [sampling, name] :
       {std::pair(core::Sampling::kPoint, "Point"),
        std::pair(core::Sampling::kArea, "Area")}) {
    const TemporaryFolder folder;
    ASSERT_EQ(
        WriteAll(folder.File("h.tif"), SomeLayout(sampling), SomeHeights()),
        absl::OkStatus());
    const DatasetPtr dataset(
        GDALDataset::Open(folder.File("h.tif").c_str(), GDAL_OF_RASTER));
    ASSERT_NE(dataset, nullptr);
    std::array<double, 6> transform;
    ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
    EXPECT_THAT(transform,
                ElementsAre(700000 - 15, 30, 0, 4050000 + 15, 0, -30));
    EXPECT_STREQ(dataset->GetMetadataItem("AREA_OR_POINT"), name);
    EXPECT_STREQ(dataset->GetMetadataItem("PREDICTOR", "IMAGE_STRUCTURE"), "3");
    OGRSpatialReference utm;
    utm.importFromEPSG(32616);
    ASSERT_NE(dataset->GetSpatialRef(), nullptr);
    EXPECT_TRUE(dataset->GetSpatialRef()->IsSame(&utm));
    EXPECT_TRUE(std::isnan(dataset->GetRasterBand(1)->GetNoDataValue()));
  }
}

TEST(HeightSink, UnfinishedFileLeavesNothingAndSparesTheOldOne) {
  const TemporaryFolder folder;
  for (const char* name : {"a.tif", "a.f32", "a.r16", "a.png", "a.exr"}) {
    const auto sink = OpenHeightSink(folder.File(name),
                                     SomeLayout(core::Sampling::kPoint), {});
    ASSERT_TRUE(sink.ok()) << sink.status();
    const std::vector<float> row(kWidth, 1.0F);
    ASSERT_EQ((*sink)->Write({0, 0, kWidth, 1}, row), absl::OkStatus());
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
}

// A limit on file sizes fails the same writes as a full disk, and needs no
// privilege.
class FullDisk : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before_), 0);
    rlimit small = before_;
    small.rlim_cur = 2000;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  }
  void TearDown() override { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST_P(FullDisk, IsAnErrorThatLeavesNothing) {
  const TemporaryFolder folder;
  const absl::Status status =
      WriteAll(folder.File(std::string("h") + GetParam()),
               SomeLayout(core::Sampling::kPoint), SomeHeights());
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr("h."));
  EXPECT_THAT(folder.Names(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(HeightSink, FullDisk,
                         testing::Values(".tif", ".f32", ".exr", ".r16",
                                         ".png"),
                         [](const auto& one) {
                           return std::string(one.param).substr(1);
                         });

TEST(HeightSink, UnknownExtensionNamesTheKnownOnes) {
  const auto format = FormatOf("h.jpg");
  EXPECT_EQ(format.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(format.status().message()), HasSubstr(".r16"));
}

TEST(HeightSink, ImageBeyondItsLimitIsRefusedBeforeAnythingIsMade) {
  const TemporaryFolder folder;
  HeightLayout layout = SomeLayout(core::Sampling::kPoint);
  layout.window = {0, 0, 1 << 20, 1 << 20};
  for (const char* name : {"h.png", "h.exr"}) {
    EXPECT_EQ(OpenHeightSink(folder.File(name), layout, {}).status().code(),
              absl::StatusCode::kInvalidArgument);
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(HeightSink, FolderThatIsNotThereIsAnErrorNamingTheFile) {
  const TemporaryFolder folder;
  const auto sink = OpenHeightSink(folder.File("missing/h.tif"),
                                   SomeLayout(core::Sampling::kPoint), {});
  EXPECT_THAT(std::string(sink.status().message()),
              HasSubstr("missing/h.tif: No such file"));
}

}  // namespace
}  // namespace terrane::client
