// TerrainCache: terrains made ready to generate from, so that asking again is
// cheap.
//
// Making a terrain ready can take a second (calibrating a refinement, indexing
// constraints); it is done once per recipe, also when several calls ask at the
// same time. Bounded in count and in bytes, least recently used out first;
// a terrain in use lives on.
//
// Threads: every method from any thread.
#ifndef TERRANE_SERVER_ACTOR_TERRAIN_CACHE_H_
#define TERRANE_SERVER_ACTOR_TERRAIN_CACHE_H_

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "absl/status/statusor.h"
#include "core/terrain/terrain.h"
#include "server/convert/terrain_convert.h"
#include "terrane/v1/terrain_recipe.pb.h"

namespace terrane::server {

// A terrain, its resolved recipe and that recipe's hash.
struct PreparedTerrain {
  std::shared_ptr<const core::Terrain> terrain;
  v1::TerrainRecipe recipe;
  std::string recipe_hash;
};

class TerrainCache {
 public:
  TerrainCache(std::size_t max_terrains, std::int64_t max_bytes)
      : max_terrains_(max_terrains), max_bytes_(max_bytes) {}

  // The terrain of `recipe`, which was read into `read` and is valid. Errors:
  // those of core::Terrain::Create; they are not kept.
  absl::StatusOr<std::shared_ptr<const PreparedTerrain>> Prepare(
      const v1::TerrainRecipe& recipe, const ReadRecipe& read);

 private:
  // One recipe. The slot's own mutex is held while its terrain is made, so that
  // others wait for that one and not for the cache.
  struct Slot {
    std::mutex mutex;
    std::shared_ptr<const PreparedTerrain> prepared;
    std::int64_t bytes = 0;
  };
  struct Entry {
    std::string key;
    std::shared_ptr<Slot> slot;
  };

  std::shared_ptr<Slot> SlotOf(const std::string& key, std::int64_t bytes);
  void Drop(const std::string& key);
  void Trim();

  const std::size_t max_terrains_;
  const std::int64_t max_bytes_;
  std::mutex mutex_;
  std::list<Entry> use_order_;  // latest used first
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
  std::int64_t bytes_ = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_TERRAIN_CACHE_H_
