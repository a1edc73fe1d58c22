// What a flower costs, before any work: exact counts from the spec alone, in
// checked arithmetic (a product beyond 2^63 - 1 stays there).
//
// Pure functions of a spec whose counts are in their ranges; safe from any
// thread.
#ifndef TERRANE_CORE_FLOWER_ESTIMATE_FLOWER_H_
#define TERRANE_CORE_FLOWER_ESTIMATE_FLOWER_H_

#include <cstdint>
#include <vector>

#include "core/flower/flower_spec.h"
#include "core/flower/solid_mesh.h"

namespace terrane::core {

struct FlowerEstimate {
  // Of the prototypes together; bytes of their columns.
  std::int64_t prototypes = 0;
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t prototype_bytes = 0;
  // Rows of the whole bed, and the bytes of their columns.
  std::int64_t instances = 0;
  std::int64_t instance_bytes = 0;
  // Numbers that the sketches of petals and leaves need by the spec's method
  // (ControlValues of core/flower/blade_mesh.h).
  std::int64_t control_values = 0;
};

FlowerEstimate EstimateFlower(const FlowerSpec& spec);

// Prototypes of one size.
struct PrototypeKind {
  MeshSize size;
  bool has_colors = false;
  std::int64_t count = 0;
};

// All the prototypes, in their order.
std::vector<PrototypeKind> PrototypeKinds(const FlowerSpec& spec);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_ESTIMATE_FLOWER_H_
