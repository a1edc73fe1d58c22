#include "core/codec/material_model.h"

#include <cmath>

#include "core/base/det_math.h"

namespace terrane::core {
namespace {

// log2(8192).
constexpr double kLobeOctaves = 13;

}  // namespace

double LobeExponent(const Material& material) {
  return DetExp2(kLobeOctaves * static_cast<double>(material.Gloss()));
}

double GgxRoughness(const Material& material) {
  return std::sqrt(std::sqrt(2 / (LobeExponent(material) + 2)));
}

double IndexOfRefraction(const Material& material) {
  const double root = std::sqrt(static_cast<double>(material.specular));
  return (1 + root) / (1 - root);
}

}  // namespace terrane::core
