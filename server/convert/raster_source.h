// RasterSource: where a recipe's rasters come from.
#ifndef TERRANE_SERVER_CONVERT_RASTER_SOURCE_H_
#define TERRANE_SERVER_CONVERT_RASTER_SOURCE_H_

#include <memory>
#include <string>

#include "core/grid/raster.h"

namespace terrane::server {

// A raster and what the core does not read of it.
struct PlacedRaster {
  std::shared_ptr<const core::Raster> raster;  // null: not kept
  std::string crs;
};

// Threads: Find may be called from any thread at any time.
class RasterSource {
 public:
  virtual ~RasterSource() = default;
  virtual PlacedRaster Find(const std::string& raster_id) = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_RASTER_SOURCE_H_
