// SurfaceService over an Actor: one thin handler per rpc.
#ifndef TERRANE_SERVER_SERVICE_SURFACE_SERVICE_H_
#define TERRANE_SERVER_SERVICE_SURFACE_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/surface.grpc.pb.h"

namespace terrane::server {

// StreamSurface is raw: its messages are serialized on the worker that made
// them, not on gRPC's thread.
using SurfaceServiceBase =
    v1::SurfaceService::WithRawCallbackMethod_StreamSurface<
        v1::SurfaceService::WithCallbackMethod_EstimateSurface<
            v1::SurfaceService::WithCallbackMethod_GetSurfacePreset<
                v1::SurfaceService::Service>>>;

class SurfaceServiceImpl final : public SurfaceServiceBase {
 public:
  explicit SurfaceServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamSurface(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* EstimateSurface(
      grpc::CallbackServerContext* context,
      const v1::EstimateSurfaceRequest* request,
      v1::EstimateSurfaceResponse* response) override;
  grpc::ServerUnaryReactor* GetSurfacePreset(
      grpc::CallbackServerContext* context,
      const v1::GetSurfacePresetRequest* request,
      v1::GetSurfacePresetResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_SURFACE_SERVICE_H_
