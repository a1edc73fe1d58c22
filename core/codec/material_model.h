// The shading model of core/mesh/scene.h in the terms of other programs.
//
// Pure functions, safe from any thread; the same bits everywhere. Source: Wang,
// Zhang & Yang 2019, section 2, with the lobe of Lazarov 2013.
#ifndef TERRANE_CORE_CODEC_MATERIAL_MODEL_H_
#define TERRANE_CORE_CODEC_MATERIAL_MODEL_H_

#include "core/mesh/scene.h"

namespace terrane::core {

// alpha = 8192^g: the exponent of a lobe (n.h)^alpha, Blinn and Phong's.
double LobeExponent(const Material& material);

// (2 / (alpha + 2))^(1/4): what glTF calls roughness, with the GGX lobe that is
// nearest.
double GgxRoughness(const Material& material);

// (1 + sqrt r0) / (1 - sqrt r0): of a dielectric with that reflectance.
double IndexOfRefraction(const Material& material);

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_MATERIAL_MODEL_H_
