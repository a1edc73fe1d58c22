// The messages of a StreamSurface rpc.
#ifndef TERRANE_SERVER_SERVICE_SURFACE_SOURCE_H_
#define TERRANE_SERVER_SERVICE_SURFACE_SOURCE_H_

#include <memory>

#include "server/service/call_context.h"
#include "server/service/stream_source.h"

namespace terrane::server {

// `request` holds a serialized StreamSurfaceRequest.
std::unique_ptr<StreamSource> MakeSurfaceSource(
    const ServiceParts& parts, const grpc::ByteBuffer& request);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_SURFACE_SOURCE_H_
