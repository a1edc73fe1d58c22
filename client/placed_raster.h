// PlacedRaster: heights in memory with their place on the ground, and where
// they come from: any raster that GDAL reads, or a .r16 or .f32 file with its
// sidecar.
//
// Threads: any. Errors: NOT_FOUND or UNKNOWN for a file that cannot be read,
// INVALID_ARGUMENT for one that does not fit (several bands, rotated, too
// large), each naming the file and what to do.
#ifndef TERRANE_CLIENT_PLACED_RASTER_H_
#define TERRANE_CLIENT_PLACED_RASTER_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "core/grid/hillshade.h"
#include "core/grid/raster.h"

namespace terrane::client {

struct PlacedRaster {
  // frame: centre of the first sample and the distance of neighbours, in the
  // CRS's units. Without a place, pixel indices.
  core::Raster raster;
  // WKT; empty when the file has none.
  std::string crs;
};

struct ReadOptions {
  // Band to read, from 1; 0: the only one.
  int band = 0;
  // Warp to this CRS first, with cubic interpolation; empty: as it is.
  std::string crs;
  // Largest number of samples that is read.
  std::int64_t max_samples = std::int64_t{1} << 28;
};

// Reads a raster with GDAL. Posts without data become NaN; the file's scale and
// offset are applied; the rows stay in the file's order.
absl::StatusOr<PlacedRaster> ReadRaster(const std::string& path,
                                        const ReadOptions& options);

// Reads a .r16 or .f32 file with its .json sidecar, anything else with GDAL.
absl::StatusOr<PlacedRaster> ReadHeights(const std::string& path,
                                         const ReadOptions& options);

// Turns the rows over when they run from south to north, so that the first is
// the northern one. Without a CRS nothing is known of north: left as it is.
void PutNorthUp(PlacedRaster* placed);

// Metres between neighbouring samples, row by row: of a geographic CRS by the
// ellipsoid's radii at the row's latitude, of a projected one by its linear
// unit. Without a CRS the spacing counts as metres. Error: a CRS that PROJ does
// not know.
absl::StatusOr<core::GroundScale> GroundScaleOf(const PlacedRaster& placed);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_PLACED_RASTER_H_
