// RemoteRenders: RenderService of a server across the network.
#ifndef TERRANE_CLIENT_REMOTE_RENDERS_H_
#define TERRANE_CLIENT_REMOTE_RENDERS_H_

#include <memory>

#include "client/remote_caller.h"
#include "client/render_backend.h"
#include "terrane/v1/render.grpc.pb.h"

namespace terrane::client {

class RemoteRenders : public RenderBackend {
 public:
  // `caller` outlives this.
  explicit RemoteRenders(RemoteCaller* caller);

  absl::Status StreamRender(const v1::StreamRenderRequest& request,
                            const OnRenderHeader& on_header,
                            const OnRenderPart& on_part,
                            std::stop_token stop) override;
  absl::StatusOr<v1::EstimateRenderResponse> EstimateRender(
      const v1::EstimateRenderRequest& request, std::stop_token stop) override;

 private:
  RemoteCaller* const caller_;
  const std::unique_ptr<v1::RenderService::Stub> stub_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_REMOTE_RENDERS_H_
