#include "client/tiff_sink.h"

#include <cpl_string.h>
#include <ogr_spatialref.h>

#include <array>
#include <limits>
#include <utility>

#include "client/gdal_support.h"
#include "client/output_file.h"

namespace terrane::client {
namespace {

// TIFF tiles have sides of whole 16s; a stream of other tiles gets GDAL's usual
// block, and GDAL's cache puts the pieces together.
int BlockSize(int tile_size) { return tile_size % 16 == 0 ? tile_size : 256; }

CPLStringList CreationOptions(int tile_size, Compression compression) {
  const std::string block = std::to_string(BlockSize(tile_size));
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", block.c_str());
  options.SetNameValue("BLOCKYSIZE", block.c_str());
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  if (compression != Compression::kNone) {
    options.SetNameValue(
        "COMPRESS", compression == Compression::kZstd ? "ZSTD" : "DEFLATE");
    options.SetNameValue("PREDICTOR", "3");
    // The last bits of fractal heights hardly compress: the quickest level
    // costs 2 % in size and takes half the time.
    options.SetNameValue("ZLEVEL", "1");
    options.SetNameValue("ZSTD_LEVEL", "1");
  }
  return options;
}

absl::Status Place(const HeightLayout& layout, GDALDataset& dataset) {
  const GdalErrorScope errors;
  // POINT samples sit on posts. GDAL counts from pixel corners in both cases
  // and moves the tie point to the centre itself.
  dataset.SetMetadataItem(
      "AREA_OR_POINT",
      layout.sampling == core::Sampling::kPoint ? "Point" : "Area");
  const core::Frame& frame = layout.frame;
  std::array<double, 6> transform = {frame.origin_x - frame.spacing_x * 0.5,
                                     frame.spacing_x,
                                     0,
                                     frame.origin_y - frame.spacing_y * 0.5,
                                     0,
                                     frame.spacing_y};
  dataset.SetGeoTransform(transform.data());
  if (!layout.crs.empty()) {
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.SetFromUserInput(layout.crs.c_str()) != OGRERR_NONE) {
      return errors.Error("frame.crs is not understood");
    }
    dataset.SetSpatialRef(&crs);
  }
  dataset.GetRasterBand(1)->SetNoDataValue(
      std::numeric_limits<double>::quiet_NaN());
  dataset.SetMetadataItem("TERRANE_RECIPE", layout.recipe_hash.c_str());
  dataset.SetMetadataItem("TERRANE_REVISION",
                          std::to_string(layout.revision).c_str());
  dataset.SetMetadataItem("TERRANE_LEVEL",
                          std::to_string(layout.level).c_str());
  if (errors.failed()) return errors.Error("cannot place the GeoTIFF");
  return absl::OkStatus();
}

class TiffSink : public HeightSink {
 public:
  TiffSink(OutputFile file, DatasetPtr dataset)
      : file_(std::move(file)), dataset_(std::move(dataset)) {}

  absl::Status Write(const core::Window& rectangle,
                     std::span<const float> heights) override {
    const GdalErrorScope errors;
    const auto columns = static_cast<int>(rectangle.width);
    const auto rows = static_cast<int>(rectangle.height);
    // GDAL's buffer is not const because the same call also reads.
    const CPLErr result = dataset_->GetRasterBand(1)->RasterIO(
        GF_Write, static_cast<int>(rectangle.x), static_cast<int>(rectangle.y),
        columns, rows, const_cast<float*>(heights.data()), columns, rows,
        GDT_Float32, 0, 0, nullptr);
    if (result != CE_None || errors.failed()) return WriteError(errors);
    return absl::OkStatus();
  }

  absl::Status Finish(const HeightTotals&) override {
    {
      // A full disk may show only when the last blocks are flushed.
      const GdalErrorScope errors;
      dataset_.reset();
      if (errors.failed()) return WriteError(errors);
    }
    return file_.Commit();
  }

 private:
  absl::Status WriteError(const GdalErrorScope& errors) const {
    return errors.Error("cannot write " + file_.path());
  }

  OutputFile file_;
  DatasetPtr dataset_;  // closed before the file goes
};

}  // namespace

absl::StatusOr<std::unique_ptr<HeightSink>> OpenTiffSink(
    const std::string& path, const HeightLayout& layout,
    Compression compression) {
  RegisterGdal();
  if (layout.window.width > std::numeric_limits<int>::max() ||
      layout.window.height > std::numeric_limits<int>::max()) {
    return absl::InvalidArgumentError(
        "window: a GeoTIFF has sides of at most "
        "2147483647 samples");
  }
  absl::StatusOr<OutputFile> file = OutputFile::Create(path);
  if (!file.ok()) return file.status();
  const GdalErrorScope errors;
  CPLStringList options = CreationOptions(layout.tile_size, compression);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  DatasetPtr dataset(driver->Create(
      file->temporary_path().c_str(), static_cast<int>(layout.window.width),
      static_cast<int>(layout.window.height), 1, GDT_Float32, options.List()));
  if (dataset == nullptr) return errors.Error("cannot create " + path);
  const absl::Status placed = Place(layout, *dataset);
  if (!placed.ok()) return placed;
  return std::make_unique<TiffSink>(std::move(*file), std::move(dataset));
}

}  // namespace terrane::client
