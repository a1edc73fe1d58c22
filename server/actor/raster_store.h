// RasterStore: uploaded rasters in memory, named by their content.
//
// Bounded in bytes, least recently used out first. A raster that a terrain in
// use holds lives on until that terrain goes; what the bound counts is what can
// be asked for by name. Uploads on their way in are bounded by the same number,
// on their own.
//
// Threads: every method from any thread. Errors: RESOURCE_EXHAUSTED when a
// raster is larger than the store.
#ifndef TERRANE_SERVER_ACTOR_RASTER_STORE_H_
#define TERRANE_SERVER_ACTOR_RASTER_STORE_H_

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/grid/raster.h"
#include "server/convert/raster_source.h"
#include "terrane/v1/raster.pb.h"

namespace terrane::server {

// A raster as it was uploaded.
struct StoredRaster {
  std::shared_ptr<const core::Raster> raster;
  // The answer to GetRaster: id, header, range.
  v1::GetRasterResponse description;
};

class RasterStore : public RasterSource {
 public:
  explicit RasterStore(std::int64_t capacity_bytes)
      : capacity_bytes_(capacity_bytes) {}

  // Room for an upload of `bytes`, given back when the token goes.
  using Reservation = std::shared_ptr<const void>;
  absl::StatusOr<Reservation> Reserve(std::int64_t bytes);

  // Keeps a raster under description.raster_id(), and answers whether its
  // content was kept already. Of equal contents the newer coordinate reference
  // system stays, which no height depends on.
  bool Insert(StoredRaster raster);

  // What is kept under an id, which counts as a use.
  std::optional<StoredRaster> Get(const std::string& raster_id);
  PlacedRaster Find(const std::string& raster_id) override;

  std::int64_t kept_bytes() const;

 private:
  using UseOrder = std::list<StoredRaster>;  // latest used first

  // All under mutex_.
  void EvictUntilFits(std::int64_t bytes);

  const std::int64_t capacity_bytes_;
  mutable std::mutex mutex_;
  UseOrder use_order_;
  std::unordered_map<std::string, UseOrder::iterator> by_id_;
  std::int64_t kept_bytes_ = 0;
  std::int64_t reserved_bytes_ = 0;
};

// Bytes of a raster's samples.
std::int64_t RasterBytes(const core::Raster& raster);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_RASTER_STORE_H_
