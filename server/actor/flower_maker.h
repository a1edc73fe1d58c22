// The flowers' half of the Actor: prototypes and instances, estimates, presets.
//
// Flowers are made ready anew for every request. A run keeps the prototypes and
// one block of instances, however large the bed. Threads: any, like the
// Actor's. Errors: violations, NOT_FOUND for a preset.
#ifndef TERRANE_SERVER_ACTOR_FLOWER_MAKER_H_
#define TERRANE_SERVER_ACTOR_FLOWER_MAKER_H_

#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "core/base/violations.h"
#include "core/flower/flower.h"
#include "server/actor/cost_meter.h"
#include "server/actor/limits.h"
#include "server/actor/message_run.h"
#include "terrane/v1/flower.pb.h"

namespace terrane::server {

class FlowerMaker {
 public:
  explicit FlowerMaker(const Limits& limits);

  // The flower of a choice, its prototypes made; null, with violations, when
  // it is not valid. `path` is the choice's in the request.
  absl::StatusOr<std::shared_ptr<const core::Flower>> Choose(
      const v1::FlowerChoice& choice, const std::string& path,
      core::Violations* violations) const;

  OpenedRun<v1::StreamFlowerResponse> Open(
      const v1::StreamFlowerRequest& request) const;
  absl::StatusOr<v1::EstimateFlowerResponse> Estimate(
      const v1::EstimateFlowerRequest& request) const;
  absl::StatusOr<v1::GetFlowerPresetResponse> GetPreset(
      const v1::GetFlowerPresetRequest& request) const;

 private:
  absl::StatusOr<std::optional<core::FlowerSpec>> ReadChoice(
      const v1::FlowerChoice& choice, const std::string& path,
      core::Violations* violations) const;

  const Limits limits_;
  const std::shared_ptr<CostMeter> meter_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_FLOWER_MAKER_H_
