// Flower: a spec made ready: prototype meshes, and where they stand.
//
// Structure apart from geometry: a flower is few prototypes and many instances
// of them. Prototypes are in the spec's unit about their own base; an instance
// takes them to metres in the bed. Every plant has the same number of rows, in
// the same order: stem, leaves, petals, solids.
//
// A Flower is immutable and thread-safe; share it by shared_ptr<const Flower>.
// Memory: its prototypes. A FlowerGenerator (core/flower/flower_generator.h)
// gives the instances in blocks.
//
// Determinism: a prototype is a pure function of (spec, index), a row of (spec,
// row index). Neither depends on blocks, threads, SIMD target or build type.
//
// Source: Wang, Zhang & Yang 2019.
#ifndef TERRANE_CORE_FLOWER_FLOWER_H_
#define TERRANE_CORE_FLOWER_FLOWER_H_

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/flower/estimate_flower.h"
#include "core/flower/flower_spec.h"
#include "core/flower/placement.h"
#include "core/flower/prototypes.h"
#include "core/flower/validate_flower.h"
#include "core/noise/perlin_noise.h"

namespace terrane::core {

class Flower {
 public:
  Flower(const Flower&) = delete;
  Flower& operator=(const Flower&) = delete;

  // Validates the spec and makes the prototypes. Errors: INVALID_ARGUMENT with
  // violations (field paths relative to the recipe, such as
  // "petals[0].blade.sketches[1].points"); CANCELLED when `stop` was asked to,
  // within a row of a prototype.
  static absl::StatusOr<std::shared_ptr<const Flower>> Create(
      const FlowerSpec& spec, const FlowerLimits& limits = {},
      const std::stop_token& stop = {});

  const FlowerSpec& spec() const { return spec_; }
  const FlowerEstimate& estimate() const { return estimate_; }
  const std::vector<FlowerPrototype>& prototypes() const { return prototypes_; }

  // What is odd but allowed, such as "petals[0].blade.relief folds: the
  // area-weighted variance of its normals is 0.52, above 0.4".
  const std::vector<std::string>& warnings() const { return warnings_; }

  // Where the instances stand.
  const Placement& placement() const { return placement_; }

  // Rows of instances of the whole bed.
  std::int64_t rows() const {
    return placement_.rows_of_plant() * spec_.bed.plants;
  }

 private:
  Flower(const FlowerSpec& spec, const std::stop_token& stop);

  const FlowerSpec spec_;
  const FlowerEstimate estimate_;
  const PerlinNoise noise_;
  const Placement placement_;
  const std::vector<FlowerPrototype> prototypes_;
  const std::vector<std::string> warnings_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_FLOWER_H_
