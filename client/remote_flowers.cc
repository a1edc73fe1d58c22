#include "client/remote_flowers.h"

#include "client/flower_verifier.h"

namespace terrane::client {

RemoteFlowers::RemoteFlowers(RemoteCaller* caller)
    : caller_(caller), stub_(v1::FlowerService::NewStub(caller->channel())) {}

absl::Status RemoteFlowers::StreamFlower(const v1::StreamFlowerRequest& request,
                                         const OnFlowerHeader& on_header,
                                         const OnFlowerPart& on_part,
                                         std::stop_token stop) {
  FlowerVerifier verifier(request);
  v1::StreamFlowerRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_part(verifier.next_index());
    return stub_->StreamFlower(context, rest);
  };
  return caller_->Stream<v1::StreamFlowerResponse>(
      open, on_header, on_part,
      [](const auto& message) -> const auto& { return message; }, stop,
      &verifier);
}

absl::StatusOr<v1::EstimateFlowerResponse> RemoteFlowers::EstimateFlower(
    const v1::EstimateFlowerRequest& request, std::stop_token stop) {
  return caller_->Unary<v1::EstimateFlowerResponse>(
      stub_.get(), &v1::FlowerService::Stub::EstimateFlower, request, stop);
}

absl::StatusOr<v1::GetFlowerPresetResponse> RemoteFlowers::GetFlowerPreset(
    const v1::GetFlowerPresetRequest& request, std::stop_token stop) {
  return caller_->Unary<v1::GetFlowerPresetResponse>(
      stub_.get(), &v1::FlowerService::Stub::GetFlowerPreset, request, stop);
}

}  // namespace terrane::client
