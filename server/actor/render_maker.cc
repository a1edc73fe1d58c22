#include "server/actor/render_maker.h"

#include <utility>

#include "server/actor/actor.h"
#include "server/actor/chosen_recipe.h"
#include "server/actor/render_run.h"
#include "server/convert/render_convert.h"

namespace terrane::server {
namespace {

// Of a path of a picture, until something was measured: a slow machine's.
constexpr double kFirstNsPerPath = 5000;
constexpr char kNoSubject[] =
    "must be a terrain, a surface, a tree or a flower, got none";

}  // namespace

RenderMaker::RenderMaker(Actor* actor, const Limits& limits)
    : actor_(actor),
      limits_(limits),
      meter_(std::make_shared<CostMeter>(kFirstNsPerPath)),
      memory_(std::make_shared<MemoryBudget>(limits.render_bytes)) {}

OpenedScene RenderMaker::OpenScene(const v1::StreamRenderRequest& request,
                                   const SceneRequest& scene) const {
  switch (request.subject_case()) {
    case v1::StreamRenderRequest::kTerrain:
      return OpenTerrainScene(request.terrain(), actor_, scene);
    case v1::StreamRenderRequest::kSurface:
      return OpenSurfaceScene(request.surface(), actor_->surfaces(), scene);
    case v1::StreamRenderRequest::kTree:
      return OpenTreeScene(request.tree(), actor_->trees(), scene);
    case v1::StreamRenderRequest::kFlower:
      return OpenFlowerScene(request.flower(), actor_->flowers(), scene);
    case v1::StreamRenderRequest::SUBJECT_NOT_SET:
      break;
  }
  scene.violations->Add(scene.prefix + "subject", kNoSubject);
  return std::unique_ptr<SceneSource>();
}

EstimatedScene RenderMaker::EstimateScene(
    const v1::StreamRenderRequest& request, const SceneRequest& scene) const {
  switch (request.subject_case()) {
    case v1::StreamRenderRequest::kTerrain:
      return EstimateTerrainScene(request.terrain(), actor_, scene);
    case v1::StreamRenderRequest::kSurface:
      return EstimateSurfaceScene(request.surface(), actor_->surfaces(), scene);
    case v1::StreamRenderRequest::kTree:
      return EstimateTreeScene(request.tree(), actor_->trees(), scene);
    case v1::StreamRenderRequest::kFlower:
      return EstimateFlowerScene(request.flower(), actor_->flowers(), scene);
    case v1::StreamRenderRequest::SUBJECT_NOT_SET:
      break;
  }
  scene.violations->Add(scene.prefix + "subject", kNoSubject);
  return core::SceneSize();
}

OpenedRun<v1::StreamRenderResponse> RenderMaker::Open(
    const v1::StreamRenderRequest& request, std::stop_token stop) const {
  core::Violations violations;
  const std::string prefix;
  const RenderPlan plan = ReadRenderPlan(request, limits_, prefix, &violations);
  auto source =
      OpenScene(request, {limits_, prefix, &violations, std::move(stop)});
  const absl::Status fault = FaultOf(violations, source.status());
  if (!fault.ok()) return fault;
  return MakeRenderRun(*std::move(source), plan, memory_, meter_);
}

absl::StatusOr<v1::EstimateRenderResponse> RenderMaker::Estimate(
    const v1::EstimateRenderRequest& request, std::stop_token stop) const {
  core::Violations violations;
  const std::string prefix = "request.";
  const RenderPlan plan =
      ReadRenderPlan(request.request(), limits_, prefix, &violations);
  const auto size = EstimateScene(
      request.request(), {limits_, prefix, &violations, std::move(stop)});
  const absl::Status fault = FaultOf(violations, size.status());
  if (!fault.ok()) return fault;
  v1::EstimateRenderResponse estimate;
  estimate.set_bands(plan.bands() - plan.first_band);
  estimate.set_data_bytes(plan.BytesFrom(plan.first_band));
  estimate.set_triangles_most(size->triangles);
  estimate.set_paths(plan.pixels() * plan.passes);
  estimate.set_cpu_seconds(meter_->Seconds(estimate.paths()));
  estimate.set_memory_bytes_most(RenderBytes(*size, plan.pixels()));
  return estimate;
}

}  // namespace terrane::server
