#include "client/local_backend_renders.h"

#include <utility>

#include "client/local_backend_run.h"
#include "client/render_verifier.h"

namespace terrane::client {

absl::Status LocalRenders::StreamRender(const v1::StreamRenderRequest& request,
                                        const OnRenderHeader& on_header,
                                        const OnRenderPart& on_part,
                                        std::stop_token stop) {
  RenderVerifier verifier(request);
  return HandOutRun(
      maker_->Open(request, stop), on_header, on_part,
      [](const auto& message) -> const auto& { return message; }, stop,
      &verifier);
}

absl::StatusOr<v1::EstimateRenderResponse> LocalRenders::EstimateRender(
    const v1::EstimateRenderRequest& request, std::stop_token stop) {
  return maker_->Estimate(request, std::move(stop));
}

}  // namespace terrane::client
