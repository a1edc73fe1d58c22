#include "server/service/render_service.h"

#include <memory>
#include <utility>

#include "server/service/run_source.h"
#include "server/service/stream_call.h"
#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerWriteReactor<grpc::ByteBuffer>* RenderServiceImpl::StreamRender(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  using Source = RunSource<v1::StreamRenderRequest, v1::StreamRenderResponse>;
  return StreamCall::Start(
      parts_, "StreamRender", context,
      std::make_unique<Source>(
          *request, [this](const auto& asked, std::stop_token stop) {
            return parts_.actor->renders().Open(asked, std::move(stop));
          }));
}

grpc::ServerUnaryReactor* RenderServiceImpl::EstimateRender(
    grpc::CallbackServerContext* context,
    const v1::EstimateRenderRequest* request,
    v1::EstimateRenderResponse* response) {
  return UnaryCall::Start(
      parts_, "EstimateRender", context,
      Answer(response, [this, request](std::stop_token stop) {
        return parts_.actor->renders().Estimate(*request, std::move(stop));
      }));
}

}  // namespace terrane::server
