// The flowers of the paper's figures and ours, as specs: what the tests, the
// goldens and the benches grow.
#ifndef TERRANE_TESTS_CORE_FLOWER_PRESETS_H_
#define TERRANE_TESTS_CORE_FLOWER_PRESETS_H_

#include <string>
#include <vector>

#include "core/flower/flower_spec.h"

namespace terrane::core {

// "rose", "pansy", "water-lily", "sunflower", "daisy", "tulip", "lily",
// "chrysanthemum", "leaf", "petal". In a fixed order.
std::vector<std::string> FlowerPresetNames();

// `name` is one of them.
FlowerSpec FlowerPreset(const std::string& name);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_FLOWER_PRESETS_H_
