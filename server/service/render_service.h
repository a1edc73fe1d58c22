// RenderService over an Actor: one thin handler per rpc.
#ifndef TERRANE_SERVER_SERVICE_RENDER_SERVICE_H_
#define TERRANE_SERVER_SERVICE_RENDER_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/render.grpc.pb.h"

namespace terrane::server {

// StreamRender is raw: its messages are serialized on the worker that made
// them, not on gRPC's thread.
using RenderServiceBase = v1::RenderService::WithRawCallbackMethod_StreamRender<
    v1::RenderService::WithCallbackMethod_EstimateRender<
        v1::RenderService::Service>>;

class RenderServiceImpl final : public RenderServiceBase {
 public:
  explicit RenderServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamRender(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* EstimateRender(
      grpc::CallbackServerContext* context,
      const v1::EstimateRenderRequest* request,
      v1::EstimateRenderResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_RENDER_SERVICE_H_
