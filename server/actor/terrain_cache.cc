#include "server/actor/terrain_cache.h"

#include <atomic>
#include <optional>
#include <stop_token>
#include <utility>

#include "server/actor/raster_store.h"
#include "server/actor/spot_table_store.h"
#include "server/convert/content_hash.h"

namespace terrane::server {
namespace {

// What the smallest terrain takes, so that the bound in bytes is one in number.
constexpr std::int64_t kEntryBytes = 16 * 1024;
// Keys are short.
constexpr std::int64_t kResolvedKeysBytes = std::int64_t{4} << 20;

// The coordinate reference system may be the raster's, so it is part of the
// key.
std::string KeyOf(const v1::TerrainRecipe& recipe, const std::string& crs) {
  return RecipeHash(recipe) + crs;
}

// What keeping a terrain costs: itself, its rasters and its table, which
// outlive their place in the stores, and its recipe, as spec and as message.
std::int64_t BytesOf(const core::Terrain& terrain,
                     const v1::TerrainRecipe& recipe, const ReadRecipe& read) {
  std::int64_t bytes = kEntryBytes + terrain.MemoryBytes() +
                       2 * static_cast<std::int64_t>(recipe.ByteSizeLong());
  for (const auto& [raster, id] : read.raster_ids) {
    bytes += RasterBytes(*raster);
  }
  if (const auto& table = read.spec.spots.table; table != nullptr) {
    bytes += SpotTableBytes(static_cast<std::int64_t>(table->size()));
  }
  return bytes;
}

absl::Status GaveUp() {
  return absl::CancelledError("the preparation was given up");
}

}  // namespace

// One caller's share in a terrain being made, until the call returns or its
// stop is asked for.
class TerrainCache::Caller {
 public:
  // `making->callers` counts this one already.
  Caller(TerrainCache* cache, const std::string& key,
         std::shared_ptr<Making> making, std::stop_token stop)
      : cache_(cache),
        key_(key),
        making_(std::move(making)),
        on_stop_(std::move(stop), LeaveOnce{this}) {}
  ~Caller() { Leave(); }
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;

 private:
  struct LeaveOnce {
    void operator()() const { caller->Leave(); }
    Caller* caller;
  };

  void Leave() {
    if (!left_.exchange(true)) cache_->Leave(key_, making_.get());
  }

  TerrainCache* const cache_;
  const std::string& key_;
  const std::shared_ptr<Making> making_;
  std::atomic<bool> left_ = false;
  // Last: it goes first, and waits for a callback that is under way.
  std::stop_callback<LeaveOnce> on_stop_;
};

TerrainCache::TerrainCache(std::int64_t max_bytes, Create create)
    : create_(std::move(create)),
      kept_(max_bytes),
      resolved_keys_(kResolvedKeysBytes) {}

TerrainCache::Result TerrainCache::Prepare(
    const v1::TerrainRecipe& recipe, const ReadRecipe& read,
    const core::Preparation& preparation) {
  if (preparation.stop.stop_requested()) return GaveUp();
  const std::string key = KeyOf(recipe, read.crs);
  std::unique_lock lock(mutex_);
  if (auto kept = FindKept(key)) return kept;
  std::shared_ptr<Making>& entry = making_[key];
  const bool first = entry == nullptr;
  if (first) entry = std::make_shared<Making>();
  const std::shared_ptr<Making> making = entry;
  ++making->callers;
  lock.unlock();

  const Caller caller(this, key, making, preparation.stop);
  if (!first) return Await(preparation, making.get());
  Result result = Make(read, preparation, making.get());
  Finish(key, making.get(), result);
  if (preparation.stop.stop_requested()) return GaveUp();
  return result;
}

std::shared_ptr<const PreparedTerrain> TerrainCache::FindKept(
    const std::string& key) {
  const std::string* resolved = resolved_keys_.Find(key);
  const auto* kept = kept_.Find(resolved != nullptr ? *resolved : key);
  return kept != nullptr ? *kept : nullptr;
}

TerrainCache::Result TerrainCache::Make(const ReadRecipe& read,
                                        const core::Preparation& preparation,
                                        Making* making) {
  core::Preparation shared;
  shared.stop = making->stop.get_token();
  shared.progress = [&](double fraction) {
    {
      std::lock_guard lock(mutex_);
      making->fraction = fraction;
    }
    changed_.notify_all();
    if (preparation.progress) preparation.progress(fraction);
  };
  auto terrain = create_(read.spec, shared);
  if (!terrain.ok()) return terrain.status();
  auto prepared = std::make_shared<PreparedTerrain>();
  prepared->recipe = WriteTerrainRecipe((*terrain)->spec(), read);
  prepared->recipe_hash = RecipeHash(prepared->recipe);
  prepared->memory_bytes = BytesOf(**terrain, prepared->recipe, read);
  prepared->terrain = *std::move(terrain);
  return prepared;
}

TerrainCache::Result TerrainCache::Await(const core::Preparation& preparation,
                                         Making* making) {
  double shown = -1;
  std::unique_lock lock(mutex_);
  while (!making->done) {
    if (making->fraction > shown) {
      shown = making->fraction;
      lock.unlock();
      if (preparation.progress) preparation.progress(shown);
      lock.lock();
      continue;
    }
    const bool news = changed_.wait(lock, preparation.stop, [&] {
      return making->done || making->fraction > shown;
    });
    if (!news) return GaveUp();
  }
  return making->result;
}

void TerrainCache::Leave(const std::string& key, Making* making) {
  std::lock_guard lock(mutex_);
  if (--making->callers > 0 || making->done) return;
  making->stop.request_stop();
  // Who asks from now on must not wait for work that is ending.
  Forget(key, making);
}

void TerrainCache::Forget(const std::string& key, const Making* making) {
  const auto entry = making_.find(key);
  if (entry != making_.end() && entry->second.get() == making) {
    making_.erase(entry);
  }
}

void TerrainCache::Finish(const std::string& key, Making* making,
                          Result result) {
  {
    std::lock_guard lock(mutex_);
    if (result.ok()) Keep(key, *result);
    making->result = std::move(result);
    making->done = true;
    Forget(key, making);
  }
  changed_.notify_all();
}

void TerrainCache::Keep(const std::string& key,
                        const std::shared_ptr<const PreparedTerrain>& made) {
  const std::string resolved = KeyOf(made->recipe, made->recipe.frame().crs());
  kept_.Insert(resolved, made, made->memory_bytes);
  resolved_keys_.Insert(
      key, resolved, static_cast<std::int64_t>(key.size() + resolved.size()));
}

std::int64_t TerrainCache::kept_bytes() const {
  std::lock_guard lock(mutex_);
  return kept_.kept_bytes();
}

}  // namespace terrane::server
