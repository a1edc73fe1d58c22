// The flowers of the paper's figures and ours, as specs: what the tests, the
// goldens and the benches grow.
#ifndef TERRANE_TESTS_CORE_FLOWER_PRESETS_H_
#define TERRANE_TESTS_CORE_FLOWER_PRESETS_H_

#include <string>
#include <vector>

#include "core/flower/flower_spec.h"

namespace terrane::core {

// Of the paper: figures 9 and 11, 10, 7, 6.
FlowerSpec Rose();
FlowerSpec Pansy();
FlowerSpec WaterLily();
FlowerSpec Sunflower();
// One blade, lying flat: its figures 4 and 5.
FlowerSpec Leaf();
FlowerSpec Petal();
// Ours.
FlowerSpec Daisy();
FlowerSpec Tulip();
FlowerSpec Lily();
FlowerSpec Chrysanthemum();

// All of them, in a fixed order: "rose", "water-lily" and so on.
std::vector<std::string> FlowerPresetNames();
// `name` is one of them.
FlowerSpec FlowerPreset(const std::string& name);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_FLOWER_PRESETS_H_
