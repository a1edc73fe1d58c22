// RenderBackend: whatever answers RenderService; see Backend
// (client/backend.h) for threads and errors.
#ifndef TERRANE_CLIENT_RENDER_BACKEND_H_
#define TERRANE_CLIENT_RENDER_BACKEND_H_

#include <functional>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "terrane/v1/render.pb.h"

namespace terrane::client {

// Takes the header, once, before any other part.
using OnRenderHeader = std::function<absl::Status(const v1::RenderHeader&)>;
// Takes the messages that hold bands, in their order, each once and verified
// (client/render_verifier.h), and those that hold progress. An error ends the
// stream and is its answer.
using OnRenderPart =
    std::function<absl::Status(const v1::StreamRenderResponse&)>;

class RenderBackend {
 public:
  virtual ~RenderBackend() = default;

  virtual absl::Status StreamRender(const v1::StreamRenderRequest& request,
                                    const OnRenderHeader& on_header,
                                    const OnRenderPart& on_part,
                                    std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::EstimateRenderResponse> EstimateRender(
      const v1::EstimateRenderRequest& request, std::stop_token stop) = 0;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_BACKEND_H_
