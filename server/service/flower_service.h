// FlowerService over an Actor: one thin handler per rpc.
#ifndef TERRANE_SERVER_SERVICE_FLOWER_SERVICE_H_
#define TERRANE_SERVER_SERVICE_FLOWER_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/flower.grpc.pb.h"

namespace terrane::server {

// StreamFlower is raw: its messages are serialized on the worker that made
// them, not on gRPC's thread.
using FlowerServiceBase = v1::FlowerService::WithRawCallbackMethod_StreamFlower<
    v1::FlowerService::WithCallbackMethod_EstimateFlower<
        v1::FlowerService::WithCallbackMethod_GetFlowerPreset<
            v1::FlowerService::Service>>>;

class FlowerServiceImpl final : public FlowerServiceBase {
 public:
  explicit FlowerServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamFlower(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* EstimateFlower(
      grpc::CallbackServerContext* context,
      const v1::EstimateFlowerRequest* request,
      v1::EstimateFlowerResponse* response) override;
  grpc::ServerUnaryReactor* GetFlowerPreset(
      grpc::CallbackServerContext* context,
      const v1::GetFlowerPresetRequest* request,
      v1::GetFlowerPresetResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_FLOWER_SERVICE_H_
