// The tiles of one admitted StreamTiles request.
#ifndef TERRANE_SERVER_ACTOR_TILE_JOB_H_
#define TERRANE_SERVER_ACTOR_TILE_JOB_H_

#include <cstdint>
#include <memory>

#include "server/actor/actor.h"
#include "server/actor/cost_meter.h"
#include "server/actor/terrain_cache.h"
#include "server/convert/request_plan.h"

namespace terrane::server {

// What the tiles of a plan are, from its first_tile on.
struct TileWork {
  std::int64_t samples = 0;
  // Of the lattices that they are cut from.
  std::int64_t points = 0;
  std::int64_t largest = 0;  // of one tile
};
TileWork WorkOf(const core::Terrain& terrain, const TilePlan& plan);

// `plan` was made for this terrain and has no violations. See TileJob
// (server/actor/actor.h).
std::shared_ptr<const TileJob> MakeTileJob(
    std::shared_ptr<const PreparedTerrain> prepared, const TilePlan& plan,
    std::shared_ptr<CostMeter> meter);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_TILE_JOB_H_
