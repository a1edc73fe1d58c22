// The upload of one table of spot heights: checked, hashed as it comes, stored
// at the end.
#ifndef TERRANE_SERVER_ACTOR_SPOT_TABLE_UPLOAD_H_
#define TERRANE_SERVER_ACTOR_SPOT_TABLE_UPLOAD_H_

#include <memory>

#include "server/actor/actor.h"
#include "server/actor/limits.h"
#include "server/actor/spot_table_store.h"

namespace terrane::server {

// `store` outlives the upload. See SpotTableUpload (server/actor/actor.h).
std::unique_ptr<SpotTableUpload> MakeSpotTableUpload(const Limits& limits,
                                                     SpotTableStore* store);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_SPOT_TABLE_UPLOAD_H_
