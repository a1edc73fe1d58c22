// The Actor's pictures: scenes of the other generators, ray traced.
//
// A run assembles its scene, builds what rays need, then traces band after band
// of rows; each message takes a few hundred milliseconds of one thread at most,
// but for building a large scene. Threads: any, like the Actor's; a run belongs
// to one at a time. Errors: violations; those of the generators;
// RESOURCE_EXHAUSTED for too many triangles or bytes.
#ifndef TERRANE_SERVER_ACTOR_RENDER_MAKER_H_
#define TERRANE_SERVER_ACTOR_RENDER_MAKER_H_

#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "core/base/violations.h"
#include "server/actor/cost_meter.h"
#include "server/actor/limits.h"
#include "server/actor/memory_budget.h"
#include "server/actor/message_run.h"
#include "server/actor/scenes/scene_source.h"
#include "terrane/v1/render.pb.h"

namespace terrane::server {

class Actor;

class RenderMaker {
 public:
  // `actor` has this as its part, and is not called before it is whole.
  RenderMaker(Actor* actor, const Limits& limits);

  // `stop` ends making a terrain or a flower ready.
  OpenedRun<v1::StreamRenderResponse> Open(
      const v1::StreamRenderRequest& request, std::stop_token stop) const;
  absl::StatusOr<v1::EstimateRenderResponse> Estimate(
      const v1::EstimateRenderRequest& request, std::stop_token stop) const;

 private:
  OpenedScene OpenScene(const v1::StreamRenderRequest& request,
                        const SceneRequest& scene) const;
  EstimatedScene EstimateScene(const v1::StreamRenderRequest& request,
                               const SceneRequest& scene) const;

  Actor* const actor_;
  const Limits limits_;
  const std::shared_ptr<CostMeter> meter_;  // of a sample of a pixel
  const std::shared_ptr<MemoryBudget> memory_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_RENDER_MAKER_H_
