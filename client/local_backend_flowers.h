// LocalFlowers: FlowerService in this process (client/local_backend.h).
#ifndef TERRANE_CLIENT_LOCAL_BACKEND_FLOWERS_H_
#define TERRANE_CLIENT_LOCAL_BACKEND_FLOWERS_H_

#include "client/flower_backend.h"
#include "server/actor/flower_maker.h"

namespace terrane::client {

class LocalFlowers : public FlowerBackend {
 public:
  // `maker` outlives this.
  explicit LocalFlowers(const server::FlowerMaker* maker) : maker_(maker) {}

  absl::Status StreamFlower(const v1::StreamFlowerRequest& request,
                            const OnFlowerHeader& on_header,
                            const OnFlowerPart& on_part,
                            std::stop_token stop) override;
  absl::StatusOr<v1::EstimateFlowerResponse> EstimateFlower(
      const v1::EstimateFlowerRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetFlowerPresetResponse> GetFlowerPreset(
      const v1::GetFlowerPresetRequest& request, std::stop_token stop) override;

 private:
  const server::FlowerMaker* const maker_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_LOCAL_BACKEND_FLOWERS_H_
