// TerrainCache: terrains made ready to generate from, so that asking again is
// cheap.
//
// Making a terrain ready can take a second (calibrating a refinement) or a
// minute (conditioning on 100,000 spot heights). It is done once per recipe:
// the first caller's thread works, whoever asks for the same recipe meanwhile
// waits and sees its progress. A caller that gives up leaves at once, but for
// the one that works: it stays as long as another waits, and the work ends when
// nobody does. Nothing of an ended or failed preparation is kept.
//
// A terrain is kept under its resolved recipe, which recipes that leave
// defaults out lead to: asking with the one or the other is the same. Bounded
// in bytes, least recently used out first; a terrain in use lives on.
//
// Threads: every method from any thread.
#ifndef TERRANE_SERVER_ACTOR_TERRAIN_CACHE_H_
#define TERRANE_SERVER_ACTOR_TERRAIN_CACHE_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <unordered_map>

#include "absl/status/statusor.h"
#include "core/terrain/terrain.h"
#include "server/actor/lru_store.h"
#include "server/convert/terrain_convert.h"
#include "terrane/v1/terrain_recipe.pb.h"

namespace terrane::server {

// A terrain, its resolved recipe and that recipe's hash.
struct PreparedTerrain {
  std::shared_ptr<const core::Terrain> terrain;
  v1::TerrainRecipe recipe;
  std::string recipe_hash;
  // What keeping it costs.
  std::int64_t memory_bytes = 0;
};

class TerrainCache {
 public:
  using Result = absl::StatusOr<std::shared_ptr<const PreparedTerrain>>;
  // Makes a terrain: core::Terrain::Create, unless a test says otherwise.
  using Create =
      std::function<absl::StatusOr<std::shared_ptr<const core::Terrain>>(
          core::TerrainSpec, const core::Preparation&)>;

  explicit TerrainCache(std::int64_t max_bytes,
                        Create create = core::Terrain::Create);

  // The terrain of `recipe`, which was read into `read` and is valid.
  // `preparation` is the caller's own: its progress is called from the caller's
  // thread, its stop gives up for this caller alone. Errors: those of
  // core::Terrain::Create; CANCELLED when the caller gave up.
  Result Prepare(const v1::TerrainRecipe& recipe, const ReadRecipe& read,
                 const core::Preparation& preparation);

  std::int64_t kept_bytes() const;

 private:
  // A terrain being made. All under mutex_.
  struct Making {
    int callers = 0;        // that want it
    std::stop_source stop;  // ends the work when nobody does
    double fraction = 0;
    bool done = false;
    Result result = absl::UnknownError("not done");
  };
  class Caller;

  // What is kept for a recipe's key; null when nothing is. Under mutex_.
  std::shared_ptr<const PreparedTerrain> FindKept(const std::string& key);
  // Does the work, on the thread of its first caller.
  Result Make(const ReadRecipe& read, const core::Preparation& preparation,
              Making* making);
  // Waits for the work of another, on its own thread.
  Result Await(const core::Preparation& preparation, Making* making);
  void Leave(const std::string& key, Making* making);
  void Finish(const std::string& key, Making* making, Result result);
  // Both under mutex_.
  void Keep(const std::string& key,
            const std::shared_ptr<const PreparedTerrain>& made);
  // Takes it out of making_, unless another has its place.
  void Forget(const std::string& key, const Making* making);

  const Create create_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::unordered_map<std::string, std::shared_ptr<Making>> making_;
  LruStore<std::shared_ptr<const PreparedTerrain>> kept_;
  // From the key of a recipe to that of its resolved one.
  LruStore<std::string> resolved_keys_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_TERRAIN_CACHE_H_
