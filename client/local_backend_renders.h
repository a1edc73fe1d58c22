// LocalRenders: RenderService in this process (client/local_backend.h).
#ifndef TERRANE_CLIENT_LOCAL_BACKEND_RENDERS_H_
#define TERRANE_CLIENT_LOCAL_BACKEND_RENDERS_H_

#include "client/render_backend.h"
#include "server/actor/render_maker.h"

namespace terrane::client {

class LocalRenders : public RenderBackend {
 public:
  // `maker` outlives this.
  explicit LocalRenders(const server::RenderMaker* maker) : maker_(maker) {}

  absl::Status StreamRender(const v1::StreamRenderRequest& request,
                            const OnRenderHeader& on_header,
                            const OnRenderPart& on_part,
                            std::stop_token stop) override;
  absl::StatusOr<v1::EstimateRenderResponse> EstimateRender(
      const v1::EstimateRenderRequest& request, std::stop_token stop) override;

 private:
  const server::RenderMaker* const maker_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_LOCAL_BACKEND_RENDERS_H_
