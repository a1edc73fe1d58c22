#include "core/flower/flower.h"

#include "core/base/violations.h"

namespace terrane::core {

Flower::Flower(const FlowerSpec& spec)
    : spec_(spec),
      estimate_(EstimateFlower(spec_)),
      noise_(spec_.seed),
      placement_(spec_, noise_),
      prototypes_(MakePrototypes(spec_, noise_)),
      warnings_(FoldWarnings(spec_, noise_)) {}

absl::StatusOr<std::shared_ptr<const Flower>> Flower::Create(
    const FlowerSpec& spec, const FlowerLimits& limits) {
  Violations violations;
  ValidateFlowerSpec(spec, limits, "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  return std::shared_ptr<const Flower>(new Flower(spec));
}

}  // namespace terrane::core
