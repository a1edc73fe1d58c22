// The surface half of the Actor: one admitted StreamSurface request, its
// estimate, its presets.
//
// Threads: any, like the Actor's. Errors: violations, NOT_FOUND for a preset.
#ifndef TERRANE_SERVER_ACTOR_SURFACE_JOB_H_
#define TERRANE_SERVER_ACTOR_SURFACE_JOB_H_

#include <cstdint>
#include <memory>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/actor/cost_meter.h"
#include "server/actor/limits.h"
#include "terrane/v1/surface.pb.h"

namespace terrane::server {

// Immutable; tiles may be made in any order, by several threads at a time.
class SurfaceJob {
 public:
  virtual ~SurfaceJob() = default;

  virtual const v1::SurfaceHeader& header() const = 0;
  // Tiles of the request, and the index of the first one to send.
  virtual std::int64_t total() const = 0;
  virtual std::int64_t first() const = 0;
  // As of TileJob (server/actor/actor.h).
  virtual double EstimatedSeconds() const = 0;
  // Generates and encodes tile `index`, first() <= index < total(), into the
  // message's mesh_tile or height_tile.
  virtual absl::Status MakeTile(std::int64_t index, std::stop_token stop,
                                v1::StreamSurfaceResponse* message) const = 0;
};

// Surfaces are made anew for every request: it takes microseconds.
class SurfaceMaker {
 public:
  explicit SurfaceMaker(const Limits& limits)
      : limits_(limits), meter_(std::make_shared<CostMeter>()) {}

  absl::StatusOr<std::shared_ptr<const SurfaceJob>> Open(
      const v1::StreamSurfaceRequest& request) const;
  absl::StatusOr<v1::EstimateSurfaceResponse> Estimate(
      const v1::EstimateSurfaceRequest& request) const;
  absl::StatusOr<v1::GetSurfacePresetResponse> GetPreset(
      const v1::GetSurfacePresetRequest& request) const;

 private:
  const Limits limits_;
  const std::shared_ptr<CostMeter> meter_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_SURFACE_JOB_H_
