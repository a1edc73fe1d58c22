#include "server/service/tree_service.h"

#include <memory>

#include "server/service/run_source.h"
#include "server/service/stream_call.h"
#include "server/service/unary_call.h"

namespace terrane::server {

grpc::ServerWriteReactor<grpc::ByteBuffer>* TreeServiceImpl::StreamTree(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  using Source = RunSource<v1::StreamTreeRequest, v1::StreamTreeResponse>;
  return StreamCall::Start(
      parts_, "StreamTree", context,
      std::make_unique<Source>(*request, [this](const auto& asked, auto) {
        return parts_.actor->trees().OpenRows(asked);
      }));
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* TreeServiceImpl::StreamTreeLeaves(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  using Source =
      RunSource<v1::StreamTreeLeavesRequest, v1::StreamTreeLeavesResponse>;
  return StreamCall::Start(
      parts_, "StreamTreeLeaves", context,
      std::make_unique<Source>(*request, [this](const auto& asked, auto) {
        return parts_.actor->trees().OpenLeaves(asked);
      }));
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* TreeServiceImpl::StreamTreeMesh(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  using Source =
      RunSource<v1::StreamTreeMeshRequest, v1::StreamTreeMeshResponse>;
  return StreamCall::Start(
      parts_, "StreamTreeMesh", context,
      std::make_unique<Source>(*request, [this](const auto& asked, auto) {
        return parts_.actor->trees().OpenMesh(asked);
      }));
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* TreeServiceImpl::StreamForest(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  using Source = RunSource<v1::StreamForestRequest, v1::StreamForestResponse>;
  return StreamCall::Start(
      parts_, "StreamForest", context,
      std::make_unique<Source>(*request, [this](const auto& asked, auto) {
        return parts_.actor->trees().OpenForest(asked);
      }));
}

grpc::ServerUnaryReactor* TreeServiceImpl::EstimateTree(
    grpc::CallbackServerContext* context,
    const v1::EstimateTreeRequest* request,
    v1::EstimateTreeResponse* response) {
  return UnaryCall::Start(parts_, "EstimateTree", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->trees().Estimate(*request);
                          }));
}

grpc::ServerUnaryReactor* TreeServiceImpl::GetTreePreset(
    grpc::CallbackServerContext* context,
    const v1::GetTreePresetRequest* request,
    v1::GetTreePresetResponse* response) {
  return UnaryCall::Start(parts_, "GetTreePreset", context,
                          Answer(response, [this, request](std::stop_token) {
                            return parts_.actor->trees().GetPreset(*request);
                          }));
}

}  // namespace terrane::server
