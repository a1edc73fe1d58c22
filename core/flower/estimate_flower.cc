#include "core/flower/estimate_flower.h"

#include <limits>

#include "core/flower/blade_mesh.h"
#include "core/flower/blade_painter.h"
#include "core/flower/instance_block.h"
#include "core/flower/placement.h"
#include "core/flower/prototypes.h"
#include "core/flower/solid_mesh.h"
#include "core/flower/stem.h"

namespace terrane::core {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
// Of a vertex: position, normal, texture coordinate; of its colour; of a
// triangle.
constexpr std::int64_t kVertexBytes = 32;
constexpr std::int64_t kColorBytes = 12;
constexpr std::int64_t kTriangleBytes = 12;

// Of numbers that are not negative.
std::int64_t Times(std::int64_t a, std::int64_t b) {
  return b != 0 && a > kMost / b ? kMost : a * b;
}
std::int64_t Plus(std::int64_t a, std::int64_t b) {
  return a > kMost - b ? kMost : a + b;
}

void AddMeshes(const PrototypeKind& kind, FlowerEstimate* estimate) {
  const std::int64_t of_vertex =
      kVertexBytes + (kind.has_colors ? kColorBytes : 0);
  const std::int64_t bytes = Plus(Times(kind.size.vertices, of_vertex),
                                  Times(kind.size.triangles, kTriangleBytes));
  estimate->prototypes = Plus(estimate->prototypes, kind.count);
  estimate->vertices =
      Plus(estimate->vertices, Times(kind.size.vertices, kind.count));
  estimate->triangles =
      Plus(estimate->triangles, Times(kind.size.triangles, kind.count));
  estimate->prototype_bytes =
      Plus(estimate->prototype_bytes, Times(bytes, kind.count));
}

PrototypeKind KindOf(const BladeSpec& blade) {
  return {BladeSize(blade), HasColors(blade.colors), BladeMeshes(blade)};
}

std::int64_t ControlValuesOf(PetalMethod method, const BladeSpec& blade) {
  std::int64_t values = 0;
  for (const Sketch& sketch : blade.sketches) {
    values += ControlValues(method, sketch);
  }
  return values;
}

}  // namespace

std::vector<PrototypeKind> PrototypeKinds(const FlowerSpec& spec) {
  std::vector<PrototypeKind> kinds;
  if (spec.stem.has_value()) {
    kinds.push_back({StemSize(*spec.stem), false, spec.stem->variants});
    if (HasStalks(spec)) kinds.push_back({CylinderSize(kStalkSides), false, 1});
  }
  for (const LeafGroup& group : spec.leaves) {
    kinds.push_back(KindOf(group.blade));
  }
  for (const PetalGroup& group : spec.petals) {
    kinds.push_back(KindOf(group.blade));
  }
  for (const SolidGroup& group : spec.solids) {
    kinds.push_back({SolidSize(group), HasColors(group), 1});
  }
  return kinds;
}

FlowerEstimate EstimateFlower(const FlowerSpec& spec) {
  FlowerEstimate estimate;
  for (const PrototypeKind& kind : PrototypeKinds(spec)) {
    AddMeshes(kind, &estimate);
  }
  std::int64_t of_plant = spec.stem.has_value() ? 1 : 0;
  for (const LeafGroup& group : spec.leaves) {
    estimate.control_values += ControlValuesOf(spec.method, group.blade);
    of_plant = Plus(of_plant, Times(group.count, RowsOfLeaf(spec, group)));
  }
  for (const PetalGroup& group : spec.petals) {
    estimate.control_values += ControlValuesOf(spec.method, group.blade);
    of_plant = Plus(of_plant, group.count);
  }
  for (const SolidGroup& group : spec.solids) {
    of_plant = Plus(of_plant, group.count);
  }
  estimate.instances = Times(of_plant, spec.bed.plants);
  estimate.instance_bytes = Times(estimate.instances, kInstanceBytes);
  return estimate;
}

}  // namespace terrane::core
