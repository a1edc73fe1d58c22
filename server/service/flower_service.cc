#include "server/service/flower_service.h"

#include <memory>

#include "server/service/run_source.h"
#include "server/service/stream_call.h"
#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerWriteReactor<grpc::ByteBuffer>* FlowerServiceImpl::StreamFlower(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  using Source = RunSource<v1::StreamFlowerRequest, v1::StreamFlowerResponse>;
  return StreamCall::Start(
      parts_, "StreamFlower", context,
      std::make_unique<Source>(
          *request, [this](const auto& asked, std::stop_token stop) {
            return parts_.actor->flowers().Open(asked, stop);
          }));
}

grpc::ServerUnaryReactor* FlowerServiceImpl::EstimateFlower(
    grpc::CallbackServerContext* context,
    const v1::EstimateFlowerRequest* request,
    v1::EstimateFlowerResponse* response) {
  return UnaryCall::Start(parts_, "EstimateFlower", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->flowers().Estimate(*request);
                          }));
}

grpc::ServerUnaryReactor* FlowerServiceImpl::GetFlowerPreset(
    grpc::CallbackServerContext* context,
    const v1::GetFlowerPresetRequest* request,
    v1::GetFlowerPresetResponse* response) {
  return UnaryCall::Start(parts_, "GetFlowerPreset", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->flowers().GetPreset(*request);
                          }));
}

}  // namespace terrane::server
