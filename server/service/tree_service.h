// TreeService over an Actor: one thin handler per rpc.
#ifndef TERRANE_SERVER_SERVICE_TREE_SERVICE_H_
#define TERRANE_SERVER_SERVICE_TREE_SERVICE_H_

#include "server/service/call_context.h"
#include "terrane/v1/tree.grpc.pb.h"

namespace terrane::server {

// The streams are raw: their messages are serialized on the worker that made
// them, not on gRPC's thread.
using TreeServiceBase = v1::TreeService::WithRawCallbackMethod_StreamTree<
    v1::TreeService::WithRawCallbackMethod_StreamTreeLeaves<
        v1::TreeService::WithRawCallbackMethod_StreamTreeMesh<
            v1::TreeService::WithRawCallbackMethod_StreamForest<
                v1::TreeService::WithCallbackMethod_EstimateTree<
                    v1::TreeService::WithCallbackMethod_GetTreePreset<
                        v1::TreeService::Service>>>>>>;

class TreeServiceImpl final : public TreeServiceBase {
 public:
  explicit TreeServiceImpl(const ServiceParts& parts) : parts_(parts) {}

  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamTree(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamTreeLeaves(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamTreeMesh(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* StreamForest(
      grpc::CallbackServerContext* context,
      const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* EstimateTree(
      grpc::CallbackServerContext* context,
      const v1::EstimateTreeRequest* request,
      v1::EstimateTreeResponse* response) override;
  grpc::ServerUnaryReactor* GetTreePreset(
      grpc::CallbackServerContext* context,
      const v1::GetTreePresetRequest* request,
      v1::GetTreePresetResponse* response) override;

 private:
  const ServiceParts& parts_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_TREE_SERVICE_H_
