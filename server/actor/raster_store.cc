#include "server/actor/raster_store.h"

#include <utility>

namespace terrane::server {

std::int64_t RasterBytes(const core::Raster& raster) {
  return static_cast<std::int64_t>(raster.values.size() * sizeof(float));
}

absl::StatusOr<RasterStore::Reservation> RasterStore::Reserve(
    std::int64_t bytes) {
  std::lock_guard lock(mutex_);
  if (bytes > capacity_bytes_ - reserved_bytes_) {
    return absl::ResourceExhaustedError(
        "the raster takes " + std::to_string(bytes) +
        " bytes; free for uploads are " +
        std::to_string(capacity_bytes_ - reserved_bytes_) + " of " +
        std::to_string(capacity_bytes_));
  }
  reserved_bytes_ += bytes;
  // The token itself has no content: only its deleter counts.
  return Reservation(this, [bytes](RasterStore* store) {
    std::lock_guard release(store->mutex_);
    store->reserved_bytes_ -= bytes;
  });
}

void RasterStore::EvictUntilFits(std::int64_t bytes) {
  while (kept_bytes_ + bytes > capacity_bytes_ && !use_order_.empty()) {
    kept_bytes_ -= RasterBytes(*use_order_.back().raster);
    by_id_.erase(use_order_.back().description.raster_id());
    use_order_.pop_back();
  }
}

bool RasterStore::Insert(StoredRaster raster) {
  std::lock_guard lock(mutex_);
  const std::string id = raster.description.raster_id();
  if (const auto kept = by_id_.find(id); kept != by_id_.end()) {
    kept->second->description = std::move(raster.description);
    use_order_.splice(use_order_.begin(), use_order_, kept->second);
    return true;
  }
  const std::int64_t bytes = RasterBytes(*raster.raster);
  EvictUntilFits(bytes);
  kept_bytes_ += bytes;
  use_order_.push_front(std::move(raster));
  by_id_[id] = use_order_.begin();
  return false;
}

std::optional<StoredRaster> RasterStore::Get(const std::string& raster_id) {
  std::lock_guard lock(mutex_);
  const auto kept = by_id_.find(raster_id);
  if (kept == by_id_.end()) return std::nullopt;
  use_order_.splice(use_order_.begin(), use_order_, kept->second);
  return *kept->second;
}

PlacedRaster RasterStore::Find(const std::string& raster_id) {
  std::optional<StoredRaster> kept = Get(raster_id);
  if (!kept.has_value()) return {};
  return {kept->raster, kept->description.header().frame().crs()};
}

std::int64_t RasterStore::kept_bytes() const {
  std::lock_guard lock(mutex_);
  return kept_bytes_;
}

}  // namespace terrane::server
