#include "client/placed_raster.h"

#include <cpl_string.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "client/gdal_support.h"
#include "client/raw_heights.h"

namespace terrane::client {
namespace {

using GeoTransform = std::array<double, 6>;

absl::StatusOr<DatasetPtr> Open(const std::string& path) {
  RegisterGdal();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return absl::NotFoundError("cannot read " + path + ": no such file");
  }
  GdalErrorScope errors;
  DatasetPtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  if (dataset == nullptr) return errors.Error("cannot read " + path);
  return dataset;
}

absl::Status CheckSize(const std::string& path, GDALDataset& dataset,
                       std::int64_t max_samples) {
  const std::int64_t samples =
      std::int64_t{dataset.GetRasterXSize()} * dataset.GetRasterYSize();
  if (samples <= max_samples) return absl::OkStatus();
  return absl::InvalidArgumentError(
      path + " is too large: " + std::to_string(dataset.GetRasterXSize()) +
      " x " + std::to_string(dataset.GetRasterYSize()) + " is " +
      std::to_string(samples) + " samples, at most " +
      std::to_string(max_samples) +
      " are taken; cut a part with gdal_translate"
      " -srcwin or coarsen it with -outsize");
}

absl::StatusOr<GDALRasterBand*> ChooseBand(const std::string& path,
                                           GDALDataset& dataset, int band) {
  const int count = dataset.GetRasterCount();
  if (band == 0 && count != 1) {
    return absl::InvalidArgumentError(path + " has " + std::to_string(count) +
                                      " bands: choose one with --band");
  }
  const int chosen = band == 0 ? 1 : band;
  if (chosen < 1 || chosen > count) {
    return absl::InvalidArgumentError("--band: must be in [1, " +
                                      std::to_string(count) + "] for " + path +
                                      ", got " + std::to_string(band));
  }
  GDALRasterBand* result = dataset.GetRasterBand(chosen);
  if (GDALDataTypeIsComplex(result->GetRasterDataType())) {
    return absl::InvalidArgumentError(path +
                                      " holds complex numbers, not heights");
  }
  return result;
}

// A view of the source in another CRS, computed as it is read: Float32, NaN
// where the source has nothing. The source must outlive it.
absl::StatusOr<DatasetPtr> Warp(const std::string& path, GDALDataset& dataset,
                                const std::string& crs) {
  const GdalErrorScope errors;
  CPLStringList arguments;
  for (const char* word : {"-t_srs", crs.c_str(), "-r", "cubic", "-of", "VRT",
                           "-ot", "Float32", "-dstnodata", "nan"}) {
    arguments.AddString(word);
  }
  const std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)>
      options(GDALWarpAppOptionsNew(arguments.List(), nullptr),
              GDALWarpAppOptionsFree);
  if (options == nullptr) return errors.Error("--crs " + crs);
  GDALDatasetH source = &dataset;
  DatasetPtr warped(GDALDataset::FromHandle(
      GDALWarp("", nullptr, 1, &source, options.get(), nullptr)));
  if (warped == nullptr || errors.failed()) {
    return errors.Error("cannot warp " + path + " to " + crs);
  }
  return warped;
}

absl::StatusOr<core::Frame> FrameOf(const std::string& path,
                                    GDALDataset& dataset) {
  GeoTransform transform;
  if (dataset.GetGeoTransform(transform.data()) != CE_None) {
    return core::Frame{};
  }
  if (transform[2] != 0 || transform[4] != 0) {
    return absl::InvalidArgumentError(
        path + " is rotated against its CRS: warp it with --crs");
  }
  // GDAL counts from the pixel's corner; a post is its centre.
  return core::Frame{transform[0] + transform[1] * 0.5,
                     transform[3] + transform[5] * 0.5, transform[1],
                     transform[5]};
}

absl::StatusOr<std::vector<float>> ReadBand(const std::string& path,
                                            GDALRasterBand& band) {
  GdalErrorScope errors;
  const int width = band.GetXSize();
  const int height = band.GetYSize();
  std::vector<float> values(static_cast<std::size_t>(width) *
                            static_cast<std::size_t>(height));
  if (band.RasterIO(GF_Read, 0, 0, width, height, values.data(), width, height,
                    GDT_Float32, 0, 0, nullptr) != CE_None) {
    return errors.Error("cannot read " + path);
  }
  int has_nodata = 0;
  const auto nodata = static_cast<float>(band.GetNoDataValue(&has_nodata));
  const double scale = band.GetScale();
  const double offset = band.GetOffset();
  const bool scaled = scale != 1 || offset != 0;
  for (float& value : values) {
    if (has_nodata != 0 && value == nodata) {
      value = std::numeric_limits<float>::quiet_NaN();
    } else if (scaled) {
      value = static_cast<float>(value * scale + offset);
    }
  }
  return values;
}

std::string CrsOf(GDALDataset& dataset) {
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  if (crs == nullptr) return "";
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  std::string result;
  if (crs->exportToWkt(&text, options) == OGRERR_NONE) result = text;
  CPLFree(text);
  return result;
}

// Metres along a degree of longitude and of latitude at a latitude, by the
// radii of curvature of the ellipsoid.
core::GroundSpacing MetresPerRadian(const OGRSpatialReference& crs,
                                    double latitude) {
  const double major = crs.GetSemiMajor();
  const double flattening =
      crs.GetInvFlattening() == 0 ? 0 : 1 / crs.GetInvFlattening();
  const double eccentricity2 = flattening * (2 - flattening);
  const double sine = std::sin(latitude);
  const double w2 = 1 - eccentricity2 * sine * sine;
  const double prime_vertical = major / std::sqrt(w2);
  const double meridian = prime_vertical * (1 - eccentricity2) / w2;
  return {prime_vertical * std::cos(latitude), meridian};
}

core::GroundScale GeographicScale(const core::Raster& raster,
                                  const OGRSpatialReference& crs) {
  const double radians =
      crs.GetAngularUnits(static_cast<const char**>(nullptr));
  // A row at a pole has no width; its slopes are taken a little away from it.
  constexpr double kLimit = std::numbers::pi / 2 - 1e-6;
  std::vector<core::GroundSpacing> rows;
  for (std::int64_t j = 0; j < raster.height; ++j) {
    const double latitude = (raster.frame.origin_y +
                             static_cast<double>(j) * raster.frame.spacing_y) *
                            radians;
    const core::GroundSpacing metres =
        MetresPerRadian(crs, std::clamp(latitude, -kLimit, kLimit));
    rows.push_back({metres.x * radians * std::abs(raster.frame.spacing_x),
                    metres.y * radians * std::abs(raster.frame.spacing_y)});
  }
  return core::GroundScale(std::move(rows));
}

}  // namespace

absl::StatusOr<PlacedRaster> ReadRaster(const std::string& path,
                                        const ReadOptions& options) {
  absl::StatusOr<DatasetPtr> dataset = Open(path);
  if (!dataset.ok()) return dataset.status();
  absl::StatusOr<GDALRasterBand*> band =
      ChooseBand(path, **dataset, options.band);
  if (!band.ok()) return band.status();
  DatasetPtr warped;
  if (!options.crs.empty()) {
    absl::StatusOr<DatasetPtr> result = Warp(path, **dataset, options.crs);
    if (!result.ok()) return result.status();
    warped = std::move(*result);
    band = warped->GetRasterBand((*band)->GetBand());
  }
  GDALDataset& source = warped != nullptr ? *warped : **dataset;
  const absl::Status size = CheckSize(path, source, options.max_samples);
  if (!size.ok()) return size;
  const absl::StatusOr<core::Frame> frame = FrameOf(path, source);
  if (!frame.ok()) return frame.status();
  absl::StatusOr<std::vector<float>> values = ReadBand(path, **band);
  if (!values.ok()) return values.status();
  return PlacedRaster{{source.GetRasterXSize(), source.GetRasterYSize(), *frame,
                       std::move(*values)},
                      CrsOf(source)};
}

absl::StatusOr<PlacedRaster> ReadHeights(const std::string& path,
                                         const ReadOptions& options) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".r16" || extension == ".f32") {
    return ReadRawHeights(path, options.max_samples);
  }
  return ReadRaster(path, options);
}

void PutNorthUp(PlacedRaster* placed) {
  core::Raster& raster = placed->raster;
  if (placed->crs.empty() || raster.frame.spacing_y < 0) return;
  const std::ptrdiff_t width = raster.width;
  for (std::int64_t j = 0; j < raster.height / 2; ++j) {
    const auto row = raster.values.begin() + j * width;
    const auto other = raster.values.begin() + (raster.height - 1 - j) * width;
    std::swap_ranges(row, row + width, other);
  }
  raster.frame.origin_y +=
      static_cast<double>(raster.height - 1) * raster.frame.spacing_y;
  raster.frame.spacing_y = -raster.frame.spacing_y;
}

absl::StatusOr<core::GroundScale> GroundScaleOf(const PlacedRaster& placed) {
  const core::Frame& frame = placed.raster.frame;
  const core::GroundSpacing spacing{std::abs(frame.spacing_x),
                                    std::abs(frame.spacing_y)};
  if (placed.crs.empty()) return core::GroundScale(spacing);
  GdalErrorScope errors;
  OGRSpatialReference crs;
  if (crs.SetFromUserInput(placed.crs.c_str()) != OGRERR_NONE) {
    return errors.Error("the CRS is not understood");
  }
  if (crs.IsGeographic() != 0) return GeographicScale(placed.raster, crs);
  const double metres = crs.GetLinearUnits(static_cast<const char**>(nullptr));
  return core::GroundScale(
      core::GroundSpacing{spacing.x * metres, spacing.y * metres});
}

}  // namespace terrane::client
