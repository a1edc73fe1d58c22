// RemoteFlowers: FlowerService of a server across the network.
#ifndef TERRANE_CLIENT_REMOTE_FLOWERS_H_
#define TERRANE_CLIENT_REMOTE_FLOWERS_H_

#include <memory>

#include "client/flower_backend.h"
#include "client/remote_caller.h"
#include "terrane/v1/flower.grpc.pb.h"

namespace terrane::client {

class RemoteFlowers : public FlowerBackend {
 public:
  // `caller` outlives this.
  explicit RemoteFlowers(RemoteCaller* caller);

  absl::Status StreamFlower(const v1::StreamFlowerRequest& request,
                            const OnFlowerHeader& on_header,
                            const OnFlowerPart& on_part,
                            std::stop_token stop) override;
  absl::StatusOr<v1::EstimateFlowerResponse> EstimateFlower(
      const v1::EstimateFlowerRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetFlowerPresetResponse> GetFlowerPreset(
      const v1::GetFlowerPresetRequest& request, std::stop_token stop) override;

 private:
  RemoteCaller* const caller_;
  const std::unique_ptr<v1::FlowerService::Stub> stub_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_REMOTE_FLOWERS_H_
