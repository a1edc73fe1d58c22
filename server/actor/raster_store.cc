#include "server/actor/raster_store.h"

#include <optional>

namespace terrane::server {

std::int64_t RasterBytes(const core::Raster& raster) {
  return static_cast<std::int64_t>(raster.values.size() * sizeof(float));
}

PlacedRaster RasterStore::Find(const std::string& raster_id) {
  const std::optional<StoredRaster> kept = Get(raster_id);
  if (!kept.has_value()) return {};
  return {kept->raster, kept->description.header().frame().crs()};
}

}  // namespace terrane::server
