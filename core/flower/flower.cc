#include "core/flower/flower.h"

#include "core/base/violations.h"

namespace terrane::core {

Flower::Flower(const FlowerSpec& spec, const std::stop_token& stop)
    : spec_(spec),
      estimate_(EstimateFlower(spec_)),
      noise_(spec_.seed),
      placement_(spec_, noise_),
      prototypes_(MakePrototypes(spec_, noise_, stop)),
      warnings_(FoldWarnings(spec_, noise_, stop)) {}

absl::StatusOr<std::shared_ptr<const Flower>> Flower::Create(
    const FlowerSpec& spec, const FlowerLimits& limits,
    const std::stop_token& stop) {
  Violations violations;
  ValidateFlowerSpec(spec, limits, "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  std::shared_ptr<const Flower> flower(new Flower(spec, stop));
  if (stop.stop_requested()) {
    return absl::CancelledError("making a flower stopped");
  }
  return flower;
}

}  // namespace terrane::core
