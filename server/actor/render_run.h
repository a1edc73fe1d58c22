// The messages of one picture: see server/actor/render_maker.h.
#ifndef TERRANE_SERVER_ACTOR_RENDER_RUN_H_
#define TERRANE_SERVER_ACTOR_RENDER_RUN_H_

#include <cstdint>
#include <memory>

#include "core/raytrace/traced_scene.h"
#include "server/actor/cost_meter.h"
#include "server/actor/memory_budget.h"
#include "server/actor/message_run.h"
#include "server/actor/scenes/scene_source.h"
#include "server/convert/render_convert.h"
#include "terrane/v1/render.pb.h"

namespace terrane::server {

// An upper bound of what a scene and its picture take.
std::int64_t RenderBytes(const core::SceneSize& size, std::int64_t pixels);

std::unique_ptr<MessageRun<v1::StreamRenderResponse>> MakeRenderRun(
    std::unique_ptr<SceneSource> source, const RenderPlan& plan,
    std::shared_ptr<MemoryBudget> memory, std::shared_ptr<CostMeter> meter);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_RENDER_RUN_H_
