#include "server/actor/terrain_cache.h"

#include <utility>

#include "server/actor/raster_store.h"
#include "server/convert/content_hash.h"

namespace terrane::server {
namespace {

absl::StatusOr<std::shared_ptr<const PreparedTerrain>> Make(
    const ReadRecipe& read) {
  auto terrain = core::Terrain::Create(read.spec);
  if (!terrain.ok()) return terrain.status();
  auto prepared = std::make_shared<PreparedTerrain>();
  prepared->recipe = WriteTerrainRecipe((*terrain)->spec(), read);
  prepared->recipe_hash = RecipeHash(prepared->recipe);
  prepared->terrain = *std::move(terrain);
  return prepared;
}

// What keeping a terrain costs: its rasters, which outlive their place in the
// raster store, and its recipe's bytes.
std::int64_t BytesOf(const v1::TerrainRecipe& recipe, const ReadRecipe& read) {
  std::int64_t bytes = static_cast<std::int64_t>(recipe.ByteSizeLong());
  for (const auto& [raster, id] : read.raster_ids) {
    bytes += RasterBytes(*raster);
  }
  return bytes;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const PreparedTerrain>> TerrainCache::Prepare(
    const v1::TerrainRecipe& recipe, const ReadRecipe& read) {
  // The coordinate reference system may be the raster's, so it is part of the
  // key.
  const std::string key = RecipeHash(recipe) + read.crs;
  const std::shared_ptr<Slot> slot = SlotOf(key, BytesOf(recipe, read));
  std::lock_guard lock(slot->mutex);
  if (slot->prepared != nullptr) return slot->prepared;
  auto prepared = Make(read);
  if (prepared.ok()) {
    slot->prepared = *prepared;
  } else {
    Drop(key);
  }
  return prepared;
}

std::shared_ptr<TerrainCache::Slot> TerrainCache::SlotOf(const std::string& key,
                                                         std::int64_t bytes) {
  std::lock_guard lock(mutex_);
  if (const auto kept = by_key_.find(key); kept != by_key_.end()) {
    use_order_.splice(use_order_.begin(), use_order_, kept->second);
    return kept->second->slot;
  }
  auto slot = std::make_shared<Slot>();
  slot->bytes = bytes;
  bytes_ += bytes;
  use_order_.push_front({key, slot});
  by_key_[key] = use_order_.begin();
  Trim();
  return slot;
}

void TerrainCache::Drop(const std::string& key) {
  std::lock_guard lock(mutex_);
  const auto kept = by_key_.find(key);
  if (kept == by_key_.end()) return;
  bytes_ -= kept->second->slot->bytes;
  use_order_.erase(kept->second);
  by_key_.erase(kept);
}

void TerrainCache::Trim() {
  while (!use_order_.empty() &&
         (use_order_.size() > max_terrains_ || bytes_ > max_bytes_)) {
    bytes_ -= use_order_.back().slot->bytes;
    by_key_.erase(use_order_.back().key);
    use_order_.pop_back();
  }
}

}  // namespace terrane::server
