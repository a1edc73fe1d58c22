#include "core/flower/prototypes.h"

#include <algorithm>
#include <utility>

#include "core/base/field_checks.h"
#include "core/flower/solid_mesh.h"
#include "core/flower/stem.h"

namespace terrane::core {
namespace {

// Tells the chance of leaf groups from that of petal groups.
constexpr std::uint32_t kLeafSalt = 1000;

void AddBlades(const FlowerSpec& spec, const BladeSpec& blade,
               FlowerOrgan organ, const std::string& name, std::uint32_t salt,
               const PerlinNoise& noise, const std::stop_token& stop,
               std::vector<FlowerPrototype>* prototypes) {
  const int sketches = static_cast<int>(blade.sketches.size());
  for (int sketch = 0; sketch < sketches; ++sketch) {
    for (int variant = 0; variant < blade.variants; ++variant) {
      for (int step = 0; step < blade.steps; ++step) {
        if (stop.stop_requested()) return;
        const BladeChoice choice = {sketch, variant, step};
        std::string full = name;
        full += ", sketch " + std::to_string(sketch);
        full += ", variant " + std::to_string(variant);
        full += ", step " + std::to_string(step);
        prototypes->push_back({std::move(full), organ, blade.material,
                               MakeBladeMesh(spec.method, blade, choice,
                                             spec.seed, salt, noise, stop)});
      }
    }
  }
}

// The largest normal variance of a blade's reliefs.
double LargestVariance(const FlowerSpec& spec, const BladeSpec& blade,
                       std::uint32_t salt, const PerlinNoise& noise,
                       const std::stop_token& stop) {
  double largest = 0;
  Relief relief = blade.relief;
  relief.gain *=
      std::max(blade.open.relief, blade.steps > 1 ? blade.closed.relief : 0);
  const int sketches = static_cast<int>(blade.sketches.size());
  for (int sketch = 0; sketch < sketches; ++sketch) {
    for (int variant = 0; variant < blade.variants; ++variant) {
      if (stop.stop_requested()) return 0;
      const LatticeOffset offset =
          OffsetOf(spec.seed, salt, {sketch, variant, 0});
      largest = std::max(
          largest, NormalVariance(
                       noise, blade.sketches[static_cast<std::size_t>(sketch)],
                       relief, offset));
    }
  }
  return largest;
}

void WarnOfFolds(const std::string& field, double variance,
                 std::vector<std::string>* warnings) {
  if (variance <= kFoldingVariance) return;
  warnings->push_back(field +
                      ".blade.relief folds: the variance of its normals by "
                      "area is " +
                      NumberText(variance) + ", above " +
                      NumberText(kFoldingVariance));
}

std::string Numbered(const char* name, std::size_t index) {
  std::string text = name;
  text += ' ';
  text += std::to_string(index);
  return text;
}

}  // namespace

std::uint32_t BladeMeshes(const BladeSpec& blade) {
  return static_cast<std::uint32_t>(blade.sketches.size()) *
         static_cast<std::uint32_t>(blade.variants * blade.steps);
}

std::uint32_t BladeIndex(const BladeSpec& blade, const BladeChoice& choice) {
  return static_cast<std::uint32_t>(
      (choice.sketch * blade.variants + choice.variant) * blade.steps +
      choice.step);
}

bool HasStalks(const FlowerSpec& spec) {
  return spec.stem.has_value() &&
         std::any_of(spec.leaves.begin(), spec.leaves.end(),
                     [](const LeafGroup& group) { return group.stalk > 0; });
}

PrototypeTable::PrototypeTable(const FlowerSpec& spec) {
  if (spec.stem.has_value()) {
    count += static_cast<std::uint32_t>(spec.stem->variants);
  }
  stalk = count;
  if (HasStalks(spec)) ++count;
  for (const LeafGroup& group : spec.leaves) {
    leaves.push_back(count);
    count += BladeMeshes(group.blade);
  }
  for (const PetalGroup& group : spec.petals) {
    petals.push_back(count);
    count += BladeMeshes(group.blade);
  }
  for (std::size_t i = 0; i < spec.solids.size(); ++i) {
    solids.push_back(count++);
  }
}

std::vector<FlowerPrototype> MakePrototypes(const FlowerSpec& spec,
                                            const PerlinNoise& noise,
                                            const std::stop_token& stop) {
  std::vector<FlowerPrototype> prototypes;
  if (spec.stem.has_value()) {
    const StemSpec& stem = *spec.stem;
    for (int variant = 0; variant < stem.variants; ++variant) {
      prototypes.push_back({Numbered("stem", static_cast<std::size_t>(variant)),
                            FlowerOrgan::kStem, stem.material,
                            MakeStem(stem, StemLine(stem, variant, noise))});
    }
    if (HasStalks(spec)) {
      prototypes.push_back({"stalk", FlowerOrgan::kStem, stem.material,
                            MakeCylinder(kStalkSides)});
    }
  }
  for (std::size_t i = 0; i < spec.leaves.size(); ++i) {
    AddBlades(spec, spec.leaves[i].blade, FlowerOrgan::kLeaf,
              Numbered("leaves", i), static_cast<std::uint32_t>(i) + kLeafSalt,
              noise, stop, &prototypes);
  }
  for (std::size_t i = 0; i < spec.petals.size(); ++i) {
    AddBlades(spec, spec.petals[i].blade, spec.petals[i].organ,
              Numbered("petals", i), static_cast<std::uint32_t>(i), noise, stop,
              &prototypes);
  }
  for (std::size_t i = 0; i < spec.solids.size(); ++i) {
    const SolidGroup& solid = spec.solids[i];
    prototypes.push_back(
        {Numbered("solids", i), solid.organ, solid.material, MakeSolid(solid)});
  }
  return prototypes;
}

std::vector<std::string> FoldWarnings(const FlowerSpec& spec,
                                      const PerlinNoise& noise,
                                      const std::stop_token& stop) {
  std::vector<std::string> warnings;
  if (spec.method != PetalMethod::kPerlin) return warnings;
  for (std::size_t i = 0; i < spec.petals.size(); ++i) {
    WarnOfFolds("petals[" + std::to_string(i) + "]",
                LargestVariance(spec, spec.petals[i].blade,
                                static_cast<std::uint32_t>(i), noise, stop),
                &warnings);
  }
  for (std::size_t i = 0; i < spec.leaves.size(); ++i) {
    WarnOfFolds(
        "leaves[" + std::to_string(i) + "]",
        LargestVariance(spec, spec.leaves[i].blade,
                        static_cast<std::uint32_t>(i) + kLeafSalt, noise, stop),
        &warnings);
  }
  return warnings;
}

}  // namespace terrane::core
