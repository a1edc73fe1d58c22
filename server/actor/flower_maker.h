// The flowers' half of the Actor: prototypes and instances, estimates, presets.
//
// Flowers are made ready anew for every request, once it is known to be valid.
// A run keeps the prototypes and one block of instances, however large the bed.
// Threads: any, like the Actor's. Errors: violations, NOT_FOUND for a preset.
#ifndef TERRANE_SERVER_ACTOR_FLOWER_MAKER_H_
#define TERRANE_SERVER_ACTOR_FLOWER_MAKER_H_

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/violations.h"
#include "core/flower/flower.h"
#include "server/actor/cost_meter.h"
#include "server/actor/limits.h"
#include "server/actor/message_run.h"
#include "terrane/v1/flower.pb.h"

namespace terrane::server {

// A flower that was asked for.
struct ChosenFlower {
  // None, with violations, when the choice is not valid, and when its preset is
  // missing.
  std::optional<core::FlowerSpec> spec;
  absl::Status missing;  // NOT_FOUND for a preset
};

class FlowerMaker {
 public:
  explicit FlowerMaker(const Limits& limits);

  // `path` is the choice's in the request.
  ChosenFlower Choose(const v1::FlowerChoice& choice, const std::string& path,
                      core::Violations* violations) const;
  // Makes the prototypes of a valid spec. CANCELLED when `stop` was asked to.
  absl::StatusOr<std::shared_ptr<const core::Flower>> Make(
      const core::FlowerSpec& spec, const std::stop_token& stop) const;

  // `stop` ends the making of the prototypes.
  OpenedRun<v1::StreamFlowerResponse> Open(
      const v1::StreamFlowerRequest& request,
      const std::stop_token& stop = {}) const;
  absl::StatusOr<v1::EstimateFlowerResponse> Estimate(
      const v1::EstimateFlowerRequest& request) const;
  absl::StatusOr<v1::GetFlowerPresetResponse> GetPreset(
      const v1::GetFlowerPresetRequest& request) const;

 private:
  const Limits limits_;
  const std::shared_ptr<CostMeter> meter_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_FLOWER_MAKER_H_
