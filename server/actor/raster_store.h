// RasterStore: uploaded rasters in memory, named by their content
// (server/actor/content_store.h). Threads: every method from any thread.
#ifndef TERRANE_SERVER_ACTOR_RASTER_STORE_H_
#define TERRANE_SERVER_ACTOR_RASTER_STORE_H_

#include <cstdint>
#include <memory>
#include <string>

#include "core/grid/raster.h"
#include "server/actor/content_store.h"
#include "server/convert/raster_source.h"
#include "terrane/v1/raster.pb.h"

namespace terrane::server {

// A raster as it was uploaded.
struct StoredRaster {
  std::shared_ptr<const core::Raster> raster;
  // The answer to GetRaster: id, header, range.
  v1::GetRasterResponse description;
};

class RasterStore : public ContentStore<StoredRaster>, public RasterSource {
 public:
  using ContentStore::ContentStore;

  PlacedRaster Find(const std::string& raster_id) override;
};

// Bytes of a raster's samples.
std::int64_t RasterBytes(const core::Raster& raster);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_RASTER_STORE_H_
