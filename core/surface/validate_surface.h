// What is wrong with a SurfaceSpec: every violation in one pass, before
// anything is allocated. Named free functions without state; safe from any
// thread.
#ifndef TERRANE_CORE_SURFACE_VALIDATE_SURFACE_H_
#define TERRANE_CORE_SURFACE_VALIDATE_SURFACE_H_

#include <string>

#include "core/base/violations.h"
#include "core/surface/surface_spec.h"

namespace terrane::core {

// Most rules of one network.
inline constexpr int kMaxWeightRules = 10'000;

// Adds a violation for each field outside its range, by its path in the recipe
// ("net.points[3].x", "network.weights[0].i", "training.learning_rate") after
// `prefix`. A learning rate is held against the largest |x|^2 of the whole
// surface, so that every part of it answers alike.
void ValidateSurface(const SurfaceSpec& spec, const std::string& prefix,
                     Violations* violations);

// Adds a violation for what keeps the surface from being a height field over
// (x, y): a direction other than z, columns or rows of the net that do not
// stand over a rectangular grid, or that fold over.
void ValidateHeightField(const SurfaceSpec& spec, const std::string& prefix,
                         Violations* violations);

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_VALIDATE_SURFACE_H_
