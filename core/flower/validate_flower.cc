#include "core/flower/validate_flower.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/field_checks.h"
#include "core/flower/blade_outline.h"
#include "core/flower/estimate_flower.h"
#include "core/flower/solid_mesh.h"
#include "core/flower/stem.h"

namespace terrane::core {
namespace {

constexpr Range kShares{0, 1};
constexpr Range kSigned{-1, 1};
constexpr Range kAngles{-180, 180};
constexpr Range kTurns{-720, 720};
constexpr Range kSizes{0, 100, true, false};
constexpr Range kLengths{0, 100};
constexpr Range kHeights{-100, 100};
constexpr std::size_t kMostGroups = 16;
constexpr std::size_t kMostSketches = 16;
constexpr std::int64_t kMostOrgans = 100'000;
constexpr std::int64_t kMostPlants = 1'000'000;
constexpr double kHalfTurn = 180;

void ValidateTint(const Path& path, const Tint& tint, FieldChecks* checks) {
  auto share = tint.begin();
  for (const char* name : {"red", "green", "blue"}) {
    checks->Number(path.Field(name), static_cast<double>(*share++), kShares);
  }
}

void ValidateMaterial(const Path& path, const Material& material,
                      FieldChecks* checks) {
  ValidateTint(path.Field("base_color"), material.base_color, checks);
  checks->Number(path.Field("roughness"),
                 static_cast<double>(material.roughness), kShares);
  checks->Number(path.Field("specular"), static_cast<double>(material.specular),
                 {0, 1, false, true});
  if (material.gloss.has_value()) {
    checks->Number(path.Field("gloss"), static_cast<double>(*material.gloss),
                   kShares);
  }
}

// Returns whether the sketch makes an outline.
bool ValidateSketch(const Path& path, const Sketch& sketch,
                    FieldChecks* checks) {
  const Path points = path.Field("points");
  bool good = checks->Count(points, sketch.points.size(), kLeastSketchPoints,
                            kMostSketchPoints);
  const std::size_t count = std::min(sketch.points.size(), kMostSketchPoints);
  double before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Path point = path.Element("points", i);
    const SketchPoint& p = sketch.points[i];
    good &= checks->Number(point.Field("x"), p.x, {0, 2, true, false});
    if (checks->Number(point.Field("y"), p.y, {before, 1, true, true})) {
      before = p.y;
    } else {
      good = false;
    }
  }
  if (!good) return false;
  const std::string fault = BladeOutline(sketch).Fault();
  if (!fault.empty()) checks->Violate(path, fault);
  return fault.empty();
}

void ValidateShape(const Path& path, const BladeShape& shape, double widest,
                   FieldChecks* checks) {
  const Path across = path.Field("across_deg");
  const bool good = checks->Number(across, shape.across_deg, kTurns);
  if (good && std::fabs(shape.across_deg) * widest > kHalfTurn) {
    const double most = kHalfTurn / widest;
    checks->Number(across, shape.across_deg, {-most, most});
  }
  checks->Number(path.Field("base_curl_deg"), shape.base_curl_deg, kTurns);
  checks->Number(path.Field("tip_curl_deg"), shape.tip_curl_deg, kTurns);
  checks->Number(path.Field("flare"), shape.flare, kSigned);
  checks->Number(path.Field("relief"), shape.relief, {0, 10});
}

void ValidateColors(const Path& path, const BladeColors& colors,
                    FieldChecks* checks) {
  ValidateTint(path.Field("base"), colors.base, checks);
  ValidateTint(path.Field("tip"), colors.tip, checks);
  checks->Number(path.Field("middle"), colors.middle, {0, 1, true, true});
  ValidateTint(path.Field("margin"), colors.margin, checks);
  checks->Number(path.Field("margin_width"), colors.margin_width, kShares);
  if (!colors.blotch.has_value()) return;
  const Path blotch = path.Field("blotch");
  ValidateTint(blotch.Field("tint"), colors.blotch->tint, checks);
  const bool from_good =
      checks->Number(blotch.Field("from"), colors.blotch->from, {0, 2});
  checks->Number(blotch.Field("to"), colors.blotch->to,
                 {from_good ? colors.blotch->from : 0, 2, true, false});
  checks->Number(blotch.Field("rays"), colors.blotch->rays, kShares);
}

void ValidateRelief(const Path& path, const Relief& relief,
                    FieldChecks* checks) {
  checks->Number(path.Field("amplitude"), relief.amplitude, {0, 10});
  checks->Number(path.Field("frequency_x"), relief.frequency_x, {0, 64});
  checks->Number(path.Field("frequency_y"), relief.frequency_y, {0, 64});
  checks->Number(path.Field("gain"), relief.gain, kSizes);
}

void ValidateBlade(const Path& path, const BladeSpec& blade,
                   FieldChecks* checks) {
  checks->Count(path.Field("sketches"), blade.sketches.size(), 1,
                kMostSketches);
  double widest = 0;
  for (std::size_t i = 0; i < blade.sketches.size(); ++i) {
    const Sketch& sketch = blade.sketches[i];
    if (ValidateSketch(path.Element("sketches", i), sketch, checks)) {
      widest = std::max(widest, BladeOutline(sketch).widest());
    }
  }
  ValidateRelief(path.Field("relief"), blade.relief, checks);
  checks->Integer(path.Field("variants"), blade.variants, 1, 16);
  ValidateShape(path.Field("closed"), blade.closed, widest, checks);
  ValidateShape(path.Field("open"), blade.open, widest, checks);
  checks->Integer(path.Field("steps"), blade.steps, 1, 16);
  if (checks->Integer(path.Field("columns"), blade.columns, 2, 512) &&
      blade.columns % 2 != 0) {
    checks->Violate(path.Field("columns"),
                    "must be even, got " + std::to_string(blade.columns));
  }
  checks->Integer(path.Field("rows"), blade.rows, 2, 1024);
  ValidateMaterial(path.Field("material"), blade.material, checks);
  ValidateColors(path.Field("colors"), blade.colors, checks);
}

void ValidateArrangement(const Path& path, const Arrangement& arrangement,
                         FieldChecks* checks) {
  checks->Number(path.Field("divergence_deg"), arrangement.divergence_deg,
                 {0, 360, true, true});
  checks->Number(path.Field("spacing"), arrangement.spacing, kLengths);
  checks->Number(path.Field("radius"), arrangement.radius, kLengths);
  checks->Number(path.Field("phase_deg"), arrangement.phase_deg, {-360, 360});
  checks->Integer(path.Field("layers"), arrangement.layers, 1, 64);
  checks->Number(path.Field("arc_deg"), arrangement.arc_deg,
                 {0, 360, true, false});
  checks->Number(path.Field("height"), arrangement.height, kHeights);
  checks->Number(path.Field("dome"), arrangement.dome, kHeights);
}

void ValidatePetals(const Path& path, const PetalGroup& group,
                    FieldChecks* checks) {
  if (group.organ != FlowerOrgan::kPetal &&
      group.organ != FlowerOrgan::kSepal && group.organ != FlowerOrgan::kLeaf &&
      group.organ != FlowerOrgan::kFloret) {
    checks->Violate(path.Field("organ"),
                    "must be a petal, a sepal, a leaf or a floret");
  }
  checks->Integer(path.Field("count"), group.count, 1, kMostOrgans);
  ValidateBlade(path.Field("blade"), group.blade, checks);
  ValidateArrangement(path.Field("arrangement"), group.arrangement, checks);
  checks->Number(path.Field("angle_deg"), group.angle_deg, kAngles);
  checks->Number(path.Field("open_angle_deg"), group.open_angle_deg, kAngles);
  checks->Number(path.Field("inner_size"), group.inner_size, kSizes);
  checks->Number(path.Field("outer_size"), group.outer_size, kSizes);
  checks->Number(path.Field("swirl_deg"), group.swirl_deg, {-90, 90});
}

void ValidateSolids(const Path& path, const SolidGroup& group,
                    FieldChecks* checks) {
  if (group.organ != FlowerOrgan::kStamen &&
      group.organ != FlowerOrgan::kPistil &&
      group.organ != FlowerOrgan::kFloret &&
      group.organ != FlowerOrgan::kReceptacle) {
    checks->Violate(path.Field("organ"),
                    "must be a stamen, a pistil, a floret or a receptacle");
  }
  checks->Integer(path.Field("count"), group.count, 1, kMostOrgans);
  ValidateArrangement(path.Field("arrangement"), group.arrangement, checks);
  checks->Number(path.Field("inner_angle_deg"), group.inner_angle_deg, kAngles);
  checks->Number(path.Field("outer_angle_deg"), group.outer_angle_deg, kAngles);
  checks->Number(path.Field("inner_size"), group.inner_size, kSizes);
  checks->Number(path.Field("outer_size"), group.outer_size, kSizes);
  const bool good =
      checks->Number(path.Field("filament_length"), group.filament_length,
                     kLengths) &
      checks->Number(path.Field("filament_radius"), group.filament_radius,
                     kLengths) &
      checks->Number(path.Field("head_length"), group.head_length, kLengths) &
      checks->Number(path.Field("head_radius"), group.head_radius, kLengths);
  if (good && !HasFilament(group) && !HasHead(group)) {
    checks->Violate(path,
                    "must have a filament or a head: both lengths or radii "
                    "are 0");
  }
  checks->Integer(path.Field("sides"), group.sides, 3, 64);
  ValidateMaterial(path.Field("material"), group.material, checks);
  ValidateTint(path.Field("filament_tint"), group.filament_tint, checks);
  ValidateTint(path.Field("head_tint"), group.head_tint, checks);
}

void ValidateLeaves(const Path& path, const LeafGroup& group,
                    FieldChecks* checks) {
  checks->Integer(path.Field("count"), group.count, 1, 1000);
  ValidateBlade(path.Field("blade"), group.blade, checks);
  const bool from_good =
      checks->Number(path.Field("from"), group.from, kShares);
  checks->Number(path.Field("to"), group.to, {from_good ? group.from : 0, 1});
  checks->Number(path.Field("angle_deg"), group.angle_deg, {-90, 90});
  checks->Number(path.Field("size"), group.size, kSizes);
  checks->Number(path.Field("divergence_deg"), group.divergence_deg, {0, 360});
  if (checks->Integer(path.Field("leaflets"), group.leaflets, 1, 15) &&
      group.leaflets % 2 == 0) {
    checks->Violate(path.Field("leaflets"),
                    "must be odd, got " + std::to_string(group.leaflets));
  }
  checks->Number(path.Field("stalk"), group.stalk, kLengths);
}

void ValidateStem(const Path& path, const StemSpec& stem, FieldChecks* checks) {
  const bool good =
      checks->Number(path.Field("height"), stem.height,
                     {0, 1000, true, false}) &
      checks->Number(path.Field("taper"), stem.taper, {0, 4, true, false}) &
      checks->Number(path.Field("bend"), stem.bend, {0, 0.5}) &
      checks->Number(path.Field("nod_deg"), stem.nod_deg, {0, 170});
  const double most = good ? std::min(10.0, MostStemRadius(stem)) : 10.0;
  checks->Number(path.Field("radius"), stem.radius, {0, most, true, false});
  checks->Integer(path.Field("variants"), stem.variants, 1, 16);
  checks->Integer(path.Field("sides"), stem.sides, 3, 64);
  checks->Integer(path.Field("rows"), stem.rows, 2, 256);
  ValidateMaterial(path.Field("material"), stem.material, checks);
}

void ValidateStage(const Path& path, const GrowthStage& stage,
                   FieldChecks* checks) {
  checks->Number(path.Field("buds"), stage.buds, {0, kMostOrgans});
  checks->Number(path.Field("angle_ratio"), stage.angle_ratio, kShares);
  checks->Number(path.Field("size"), stage.size, kSizes);
  checks->Number(path.Field("spread"), stage.spread, {0, 10, true, false});
}

void ValidateBed(const Path& path, const BedSpec& bed, FieldChecks* checks) {
  checks->Integer(path.Field("plants"), bed.plants, 1, kMostPlants);
  checks->Number(path.Field("spacing_m"), bed.spacing_m, kSizes);
  checks->Number(path.Field("jitter"), bed.jitter, kShares);
  checks->Number(path.Field("turn_deg"), bed.turn_deg, {0, kHalfTurn});
}

void ValidateOrgans(const Path& root, const FlowerSpec& spec,
                    FieldChecks* checks) {
  checks->Count(root.Field("petals"), spec.petals.size(), 0, kMostGroups);
  checks->Count(root.Field("solids"), spec.solids.size(), 0, kMostGroups);
  checks->Count(root.Field("leaves"), spec.leaves.size(), 0, kMostGroups);
  if (spec.petals.empty() && spec.solids.empty() && spec.leaves.empty() &&
      !spec.stem.has_value()) {
    checks->Violate(root.Field("petals"),
                    "must have at least 1 elements where there are no solids, "
                    "no leaves and no stem, got 0");
  }
  for (std::size_t i = 0; i < spec.petals.size(); ++i) {
    ValidatePetals(root.Element("petals", i), spec.petals[i], checks);
  }
  for (std::size_t i = 0; i < spec.solids.size(); ++i) {
    ValidateSolids(root.Element("solids", i), spec.solids[i], checks);
  }
  for (std::size_t i = 0; i < spec.leaves.size(); ++i) {
    ValidateLeaves(root.Element("leaves", i), spec.leaves[i], checks);
  }
  if (spec.stem.has_value()) {
    ValidateStem(root.Field("stem"), *spec.stem, checks);
  }
}

void ValidateSize(const Path& root, const FlowerSpec& spec,
                  const FlowerLimits& limits, FieldChecks* checks) {
  const FlowerEstimate estimate = EstimateFlower(spec);
  if (estimate.prototype_bytes > limits.max_prototype_bytes) {
    checks->Violate(root.Field("petals"),
                    "must make prototypes of at most " +
                        std::to_string(limits.max_prototype_bytes) +
                        " bytes, got " +
                        std::to_string(estimate.prototype_bytes));
  }
  if (estimate.instances > limits.max_instances) {
    checks->Violate(
        root.Field("bed").Field("plants"),
        "must make at most " + std::to_string(limits.max_instances) +
            " instances, got " + std::to_string(estimate.instances));
  }
}

}  // namespace

void ValidateFlowerSpec(const FlowerSpec& spec, const FlowerLimits& limits,
                        const std::string& prefix, Violations* violations) {
  const Path root(&prefix);
  FieldChecks checks(violations);
  const std::size_t before = violations->total();
  checks.Number(root.Field("unit_m"), spec.unit_m, {0, 10, true, false});
  ValidateOrgans(root, spec, &checks);
  checks.Number(root.Field("stage"), spec.stage, kShares);
  ValidateStage(root.Field("early"), spec.early, &checks);
  ValidateStage(root.Field("full"), spec.full, &checks);
  checks.Number(root.Field("variation"), spec.variation, kShares);
  ValidateBed(root.Field("bed"), spec.bed, &checks);
  if (violations->total() == before) ValidateSize(root, spec, limits, &checks);
}

}  // namespace terrane::core
