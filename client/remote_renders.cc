#include "client/remote_renders.h"

#include "client/render_verifier.h"

namespace terrane::client {

RemoteRenders::RemoteRenders(RemoteCaller* caller)
    : caller_(caller), stub_(v1::RenderService::NewStub(caller->channel())) {}

absl::Status RemoteRenders::StreamRender(const v1::StreamRenderRequest& request,
                                         const OnRenderHeader& on_header,
                                         const OnRenderPart& on_part,
                                         std::stop_token stop) {
  RenderVerifier verifier(request);
  v1::StreamRenderRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_band(verifier.next_index());
    return stub_->StreamRender(context, rest);
  };
  return caller_->Stream<v1::StreamRenderResponse>(
      open, on_header, on_part,
      [](const auto& message) -> const auto& { return message; }, stop,
      &verifier);
}

absl::StatusOr<v1::EstimateRenderResponse> RemoteRenders::EstimateRender(
    const v1::EstimateRenderRequest& request, std::stop_token stop) {
  return caller_->Unary<v1::EstimateRenderResponse>(
      stub_.get(), &v1::RenderService::Stub::EstimateRender, request, stop);
}

}  // namespace terrane::client
