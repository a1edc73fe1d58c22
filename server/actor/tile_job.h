// The tiles of one admitted StreamTiles request.
#ifndef TERRANE_SERVER_ACTOR_TILE_JOB_H_
#define TERRANE_SERVER_ACTOR_TILE_JOB_H_

#include <memory>

#include "server/actor/actor.h"
#include "server/actor/cost_meter.h"
#include "server/actor/terrain_cache.h"
#include "server/convert/request_plan.h"

namespace terrane::server {

// `plan` was made for this terrain and has no violations. See TileJob
// (server/actor/actor.h).
std::shared_ptr<const TileJob> MakeTileJob(
    std::shared_ptr<const PreparedTerrain> prepared, const TilePlan& plan,
    std::shared_ptr<CostMeter> meter);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_TILE_JOB_H_
