#include "server/service/surface_service.h"

#include "server/service/stream_call.h"
#include "server/service/surface_source.h"
#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerWriteReactor<grpc::ByteBuffer>* SurfaceServiceImpl::StreamSurface(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  return StreamCall::Start(parts_, "StreamSurface", context,
                           MakeSurfaceSource(parts_, *request));
}

grpc::ServerUnaryReactor* SurfaceServiceImpl::EstimateSurface(
    grpc::CallbackServerContext* context,
    const v1::EstimateSurfaceRequest* request,
    v1::EstimateSurfaceResponse* response) {
  return UnaryCall::Start(parts_, "EstimateSurface", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->surfaces().Estimate(*request);
                          }));
}

grpc::ServerUnaryReactor* SurfaceServiceImpl::GetSurfacePreset(
    grpc::CallbackServerContext* context,
    const v1::GetSurfacePresetRequest* request,
    v1::GetSurfacePresetResponse* response) {
  return UnaryCall::Start(parts_, "GetSurfacePreset", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->surfaces().GetPreset(*request);
                          }));
}

}  // namespace terrane::server
