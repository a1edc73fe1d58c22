// SceneSource: the scene of a picture, assembled part by part from the very
// messages that the generator's own stream would send.
//
// Belongs to one thread at a time. A part takes about as long as one message of
// that stream, so that a worker's other streams take turns. Errors: those of
// the generator; RESOURCE_EXHAUSTED for a scene of too many triangles.
#ifndef TERRANE_SERVER_ACTOR_SCENES_SCENE_SOURCE_H_
#define TERRANE_SERVER_ACTOR_SCENES_SCENE_SOURCE_H_

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/violations.h"
#include "core/mesh/scene.h"
#include "core/raytrace/traced_scene.h"
#include "server/actor/flower_maker.h"
#include "server/actor/limits.h"
#include "server/actor/surface_job.h"
#include "server/actor/tree_maker.h"
#include "terrane/v1/render.pb.h"

namespace terrane::server {

class Actor;

class SceneSource {
 public:
  virtual ~SceneSource() = default;

  // Of the resolved recipe that is drawn.
  virtual const std::string& recipe_hash() const = 0;
  // Makes the next part; not when Ready().
  virtual absl::Status Advance(std::stop_token stop) = 0;
  // How much was made, 0 to 1, never falling.
  virtual double share() const = 0;
  virtual bool Ready() const = 0;
  // What was made, when Ready(): refers to this.
  virtual core::Scene scene() const = 0;
};

// What is asked of every source.
struct SceneRequest {
  const Limits& limits;
  // Stands before the path of each field, such as "request.".
  const std::string& prefix;
  core::Violations* violations;
  std::stop_token stop;
};

// Null when there are violations, also those that were there before: then
// nothing was made. Errors other than violations: NOT_FOUND, CANCELLED,
// RESOURCE_EXHAUSTED.
using OpenedScene = absl::StatusOr<std::unique_ptr<SceneSource>>;

OpenedScene OpenTerrainScene(const v1::TerrainSubject& subject, Actor* actor,
                             const SceneRequest& request);
OpenedScene OpenSurfaceScene(const v1::SurfaceSubject& subject,
                             const SurfaceMaker& surfaces,
                             const SceneRequest& request);
OpenedScene OpenTreeScene(const v1::TreeSubject& subject,
                          const TreeMaker& trees, const SceneRequest& request);
OpenedScene OpenFlowerScene(const v1::FlowerSubject& subject,
                            const FlowerMaker& flowers,
                            const SceneRequest& request);

// What the scene holds at most, without making any of it: at most 2^42 of
// everything, so that bytes of them do not overflow. Of no meaning when there
// are violations.
using EstimatedScene = absl::StatusOr<core::SceneSize>;

EstimatedScene EstimateTerrainScene(const v1::TerrainSubject& subject,
                                    Actor* actor, const SceneRequest& request);
EstimatedScene EstimateSurfaceScene(const v1::SurfaceSubject& subject,
                                    const SurfaceMaker& surfaces,
                                    const SceneRequest& request);
EstimatedScene EstimateTreeScene(const v1::TreeSubject& subject,
                                 const TreeMaker& trees,
                                 const SceneRequest& request);
EstimatedScene EstimateFlowerScene(const v1::FlowerSubject& subject,
                                   const FlowerMaker& flowers,
                                   const SceneRequest& request);

// Adds the violations of a generator's status: `to` stands for what its fields
// have before their own path, `from`. OK when there were some; any other status
// as it came.
absl::Status MoveViolations(const absl::Status& status, const std::string& from,
                            const std::string& to,
                            core::Violations* violations);

// RESOURCE_EXHAUSTED when there are more triangles than the limit.
absl::Status CheckTriangles(std::int64_t triangles, const Limits& limits);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_SCENES_SCENE_SOURCE_H_
