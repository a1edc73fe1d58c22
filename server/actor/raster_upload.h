// The upload of one raster: checked, hashed as it comes, stored at the end.
#ifndef TERRANE_SERVER_ACTOR_RASTER_UPLOAD_H_
#define TERRANE_SERVER_ACTOR_RASTER_UPLOAD_H_

#include <memory>

#include "server/actor/actor.h"
#include "server/actor/limits.h"
#include "server/actor/raster_store.h"

namespace terrane::server {

// `store` outlives the upload. See RasterUpload (server/actor/actor.h).
std::unique_ptr<RasterUpload> MakeRasterUpload(const Limits& limits,
                                               RasterStore* store);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_RASTER_UPLOAD_H_
