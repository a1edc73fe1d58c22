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

void AddMeshes(const MeshSize& size, bool has_colors, std::int64_t count,
               FlowerEstimate* estimate) {
  const std::int64_t of_vertex = kVertexBytes + (has_colors ? kColorBytes : 0);
  const std::int64_t bytes = Plus(Times(size.vertices, of_vertex),
                                  Times(size.triangles, kTriangleBytes));
  estimate->prototypes = Plus(estimate->prototypes, count);
  estimate->vertices = Plus(estimate->vertices, Times(size.vertices, count));
  estimate->triangles = Plus(estimate->triangles, Times(size.triangles, count));
  estimate->prototype_bytes =
      Plus(estimate->prototype_bytes, Times(bytes, count));
}

void AddBlades(PetalMethod method, const BladeSpec& blade,
               FlowerEstimate* estimate) {
  for (const Sketch& sketch : blade.sketches) {
    estimate->control_values += ControlValues(method, sketch);
  }
  AddMeshes(BladeSize(blade), HasColors(blade.colors), BladeMeshes(blade),
            estimate);
}

}  // namespace

FlowerEstimate EstimateFlower(const FlowerSpec& spec) {
  FlowerEstimate estimate;
  std::int64_t of_plant = 0;
  if (spec.stem.has_value()) {
    AddMeshes(StemSize(*spec.stem), false, spec.stem->variants, &estimate);
    if (HasStalks(spec)) {
      AddMeshes(CylinderSize(kStalkSides), false, 1, &estimate);
    }
    of_plant = 1;
  }
  for (const LeafGroup& group : spec.leaves) {
    AddBlades(spec.method, group.blade, &estimate);
    of_plant = Plus(of_plant, Times(group.count, RowsOfLeaf(spec, group)));
  }
  for (const PetalGroup& group : spec.petals) {
    AddBlades(spec.method, group.blade, &estimate);
    of_plant = Plus(of_plant, group.count);
  }
  for (const SolidGroup& group : spec.solids) {
    AddMeshes(SolidSize(group), HasColors(group), 1, &estimate);
    of_plant = Plus(of_plant, group.count);
  }
  estimate.instances = Times(of_plant, spec.bed.plants);
  estimate.instance_bytes = Times(estimate.instances, kInstanceBytes);
  return estimate;
}

}  // namespace terrane::core
