#include "client/placed_raster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "client/gdal_support.h"
#include "client/output_file.h"
#include "client/raw_heights.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using testing::HasSubstr;

const char kDem[] = TERRANE_TEST_DATA "/jacksboro-3arcsec-4326.tif";

// A raster made with GDAL itself.
void MakeRaster(const std::string& path, int bands, GDALDataType type,
                const std::function<void(GDALDataset*)>& fill) {
  RegisterGdal();
  const DatasetPtr dataset(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
          path.c_str(), 4, 3, bands, type, nullptr));
  ASSERT_NE(dataset, nullptr);
  fill(dataset.get());
}

std::string ErrorOf(const std::string& path, const ReadOptions& options = {}) {
  return std::string(ReadHeights(path, options).status().message());
}

TEST(PlacedRaster, ElevationModelHasItsPostsAtPixelCentres) {
  const auto dem = ReadRaster(kDem, {});
  ASSERT_TRUE(dem.ok()) << dem.status();
  EXPECT_EQ(dem->raster.width, 403);
  EXPECT_EQ(dem->raster.height, 344);
  const double spacing = 1 / 1200.0;
  EXPECT_NEAR(dem->raster.frame.spacing_x, spacing, 1e-12);
  EXPECT_NEAR(dem->raster.frame.spacing_y, -spacing, 1e-12);
  EXPECT_NEAR(dem->raster.frame.origin_x, -84.41375 + spacing / 2, 1e-9);
  EXPECT_NEAR(dem->raster.frame.origin_y, 36.732916666 + -spacing / 2, 1e-8);
  EXPECT_THAT(dem->crs, HasSubstr("WGS 84"));
}

TEST(PlacedRaster, GeographicSpacingBecomesMetresRowByRow) {
  const auto dem = ReadRaster(kDem, {});
  ASSERT_TRUE(dem.ok()) << dem.status();
  const auto scale = GroundScaleOf(*dem);
  ASSERT_TRUE(scale.ok()) << scale.status();
  // At 36.73 and 36.45 degrees north on WGS 84, from the length of a degree.
  EXPECT_NEAR(scale->Row(0).x, 89320.0 / 1200, 0.1);
  EXPECT_NEAR(scale->Row(343).x, 89650.0 / 1200, 0.1);
  EXPECT_NEAR(scale->Row(0).y, 110977.0 / 1200, 0.1);
  EXPECT_LT(scale->Row(0).x, scale->Row(343).x);
}

TEST(PlacedRaster, WarpPutsItOnAnotherGrid) {
  ReadOptions options;
  options.crs = "EPSG:32616";
  const auto warped = ReadRaster(kDem, options);
  ASSERT_TRUE(warped.ok()) << warped.status();
  EXPECT_THAT(warped->crs, HasSubstr("UTM zone 16N"));
  EXPECT_GT(warped->raster.frame.spacing_x, 70);
  EXPECT_LT(warped->raster.frame.spacing_x, 100);
  const auto scale = GroundScaleOf(*warped);
  ASSERT_TRUE(scale.ok()) << scale.status();
  EXPECT_DOUBLE_EQ(scale->Row(0).x, warped->raster.frame.spacing_x);
  // The corners that the turned grid leaves empty are no data.
  EXPECT_TRUE(std::isnan(warped->raster.values.front()) ||
              std::isnan(warped->raster.values.back()));
}

TEST(PlacedRaster, NodataBecomesNanAndScaleIsApplied) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.tif");
  MakeRaster(path, 1, GDT_Int16, [](GDALDataset* dataset) {
    std::vector<std::int16_t> values(12, 10);
    values[5] = -32768;
    GDALRasterBand* band = dataset->GetRasterBand(1);
    band->SetNoDataValue(-32768);
    band->SetScale(0.5);
    band->SetOffset(100);
    ASSERT_EQ(band->RasterIO(GF_Write, 0, 0, 4, 3, values.data(), 4, 3,
                             GDT_Int16, 0, 0, nullptr),
              CE_None);
  });
  const auto read = ReadRaster(path, {});
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_TRUE(std::isnan(read->raster.values[5]));
  EXPECT_EQ(read->raster.values[4], 105);
}

TEST(PlacedRaster, SouthUpIsTurnedOverInPlace) {
  PlacedRaster placed;
  placed.raster = {2, 3, {0, 10, 1, 5}, {1, 2, 3, 4, 5, 6}};
  placed.crs = "EPSG:32616";
  PutNorthUp(&placed);
  EXPECT_THAT(placed.raster.values, testing::ElementsAre(5, 6, 3, 4, 1, 2));
  EXPECT_EQ(placed.raster.frame, (core::Frame{0, 20, 1, -5}));
}

TEST(PlacedRaster, WhatDoesNotFitSaysSoAndWhatToDo) {
  const TemporaryFolder folder;
  EXPECT_THAT(ErrorOf(folder.File("missing.tif")), HasSubstr("no such file"));

  const std::string text = folder.File("text.tif");
  std::ofstream(text) << "this is no raster";
  EXPECT_THAT(ErrorOf(text), HasSubstr("cannot read " + text));

  const std::string bands = folder.File("bands.tif");
  MakeRaster(bands, 3, GDT_Byte, [](GDALDataset*) {});
  EXPECT_THAT(ErrorOf(bands), HasSubstr("has 3 bands: choose one with --band"));
  ReadOptions fourth;
  fourth.band = 4;
  EXPECT_THAT(ErrorOf(bands, fourth), HasSubstr("must be in [1, 3]"));
  ReadOptions second;
  second.band = 2;
  EXPECT_TRUE(ReadRaster(bands, second).ok());

  const std::string rotated = folder.File("rotated.tif");
  MakeRaster(rotated, 1, GDT_Byte, [](GDALDataset* dataset) {
    double transform[] = {0, 1, 0.2, 0, 0.2, -1};
    dataset->SetGeoTransform(transform);
  });
  EXPECT_THAT(ErrorOf(rotated), HasSubstr("rotated"));

  ReadOptions small;
  small.max_samples = 100'000;
  EXPECT_THAT(ErrorOf(kDem, small), HasSubstr("too large: 403 x 344"));

  ReadOptions nowhere;
  nowhere.crs = "EPSG:nonsense";
  EXPECT_FALSE(ReadRaster(kDem, nowhere).ok());
}

TEST(PlacedRaster, RawFileThatIsNotAsItsSidecarSaysIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.r16");
  std::ofstream(path) << "12345";
  EXPECT_THAT(ErrorOf(path), HasSubstr("a.r16.json"));

  HeightSidecar sidecar;
  sidecar.set_encoding("uint16-le");
  sidecar.set_width(2);
  sidecar.set_height(2);
  ASSERT_EQ(WriteSidecar(path, sidecar), absl::OkStatus());
  EXPECT_THAT(ErrorOf(path), HasSubstr("is not 8 bytes long"));

  sidecar.set_width(1e30);
  ASSERT_EQ(WriteSidecar(path, sidecar), absl::OkStatus());
  EXPECT_THAT(ErrorOf(path), HasSubstr("width and height"));

  sidecar.set_width(2);
  sidecar.set_encoding("uint24");
  ASSERT_EQ(WriteSidecar(path, sidecar), absl::OkStatus());
  EXPECT_THAT(ErrorOf(path), HasSubstr("got \"uint24\""));
}

}  // namespace
}  // namespace terrane::client
