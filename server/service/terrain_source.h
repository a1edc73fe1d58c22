// The messages of a StreamTiles rpc.
#ifndef TERRANE_SERVER_SERVICE_TERRAIN_SOURCE_H_
#define TERRANE_SERVER_SERVICE_TERRAIN_SOURCE_H_

#include <memory>

#include "server/service/call_context.h"
#include "server/service/stream_source.h"

namespace terrane::server {

// `request` holds a serialized StreamTilesRequest.
std::unique_ptr<StreamSource> MakeTerrainSource(
    const ServiceParts& parts, const grpc::ByteBuffer& request);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_TERRAIN_SOURCE_H_
