#include "client/local_backend_flowers.h"

#include "client/flower_verifier.h"
#include "client/local_backend_run.h"

namespace terrane::client {

absl::Status LocalFlowers::StreamFlower(const v1::StreamFlowerRequest& request,
                                        const OnFlowerHeader& on_header,
                                        const OnFlowerPart& on_part,
                                        std::stop_token stop) {
  FlowerVerifier verifier(request);
  return HandOutRun(
      maker_->Open(request, stop), on_header, on_part,
      [](const auto& message) -> const auto& { return message; }, stop,
      &verifier);
}

absl::StatusOr<v1::EstimateFlowerResponse> LocalFlowers::EstimateFlower(
    const v1::EstimateFlowerRequest& request, std::stop_token) {
  return maker_->Estimate(request);
}

absl::StatusOr<v1::GetFlowerPresetResponse> LocalFlowers::GetFlowerPreset(
    const v1::GetFlowerPresetRequest& request, std::stop_token) {
  return maker_->GetPreset(request);
}

}  // namespace terrane::client
