// The meshes of a flower, in a fixed order: stems by variant, the stalk of
// leaves, leaf groups, petal groups, solid groups; in a group of blades by
// sketch, then variant, then step.
//
// Pure functions of a valid spec; safe from any thread.
#ifndef TERRANE_CORE_FLOWER_PROTOTYPES_H_
#define TERRANE_CORE_FLOWER_PROTOTYPES_H_

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "core/flower/blade_mesh.h"
#include "core/flower/flower_spec.h"
#include "core/mesh/mesh.h"
#include "core/noise/perlin_noise.h"

namespace terrane::core {

// A mesh that instances share.
struct FlowerPrototype {
  std::string name;  // such as "petals 0, sketch 1, variant 0, step 2"
  FlowerOrgan organ = FlowerOrgan::kPetal;
  Material material;
  Mesh mesh;
};

// The index of the first prototype of each kind and group.
struct PrototypeTable {
  explicit PrototypeTable(const FlowerSpec& spec);

  std::uint32_t stems = 0;
  std::uint32_t stalk = 0;
  std::vector<std::uint32_t> leaves;
  std::vector<std::uint32_t> petals;
  std::vector<std::uint32_t> solids;
  std::uint32_t count = 0;
};

// Faces around the stalk of a leaf.
inline constexpr int kStalkSides = 8;

// Meshes that a blade has; the index of one among them.
std::uint32_t BladeMeshes(const BladeSpec& blade);
std::uint32_t BladeIndex(const BladeSpec& blade, const BladeChoice& choice);

// Whether leaves have stalks: they need a stem to be as thick as a part of.
bool HasStalks(const FlowerSpec& spec);

// Of no use when `stop` was asked to.
std::vector<FlowerPrototype> MakePrototypes(const FlowerSpec& spec,
                                            const PerlinNoise& noise,
                                            const std::stop_token& stop);

// One for each group whose relief folds in some sketch and variant. Of no use
// when `stop` was asked to.
std::vector<std::string> FoldWarnings(const FlowerSpec& spec,
                                      const PerlinNoise& noise,
                                      const std::stop_token& stop);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_PROTOTYPES_H_
