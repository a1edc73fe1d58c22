// The enums of the API and of the core, side by side: one row per value, the
// first row is what an unset field means. Threads: any.
#ifndef TERRANE_SERVER_CONVERT_ENUM_TABLE_H_
#define TERRANE_SERVER_CONVERT_ENUM_TABLE_H_

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/grid/lattice_window.h"
#include "core/surface/surface_spec.h"
#include "core/terrain/spec_checks.h"
#include "core/terrain/terrain_spec.h"
#include "terrane/v1/surface_recipe.pb.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::server {

template <typename Proto, typename Core, std::size_t kSize>
using EnumTable = std::array<std::pair<Proto, Core>, kSize>;

inline constexpr EnumTable<v1::FractalSource, core::FractalSource, 3>
    kFractalSources{{
        {v1::FRACTAL_SOURCE_SUBDIVISION, core::FractalSource::kSubdivision},
        {v1::FRACTAL_SOURCE_MIDPOINT, core::FractalSource::kMidpoint},
        {v1::FRACTAL_SOURCE_SUCCESSIVE, core::FractalSource::kSuccessive},
    }};

inline constexpr EnumTable<v1::HeightMapping, core::HeightMapping, 2>
    kHeightMappings{{
        {v1::HEIGHT_MAPPING_LINEAR, core::HeightMapping::kLinear},
        {v1::HEIGHT_MAPPING_BOLTZMANN, core::HeightMapping::kBoltzmann},
    }};

inline constexpr EnumTable<v1::SplineBasis, core::SplineBasis, 5> kSplineBases{{
    {v1::SPLINE_BASIS_BSPLINE_CLAMPED, core::SplineBasis::kBSplineClamped},
    {v1::SPLINE_BASIS_BSPLINE_UNIFORM, core::SplineBasis::kBSplineUniform},
    {v1::SPLINE_BASIS_BEZIER, core::SplineBasis::kBezier},
    {v1::SPLINE_BASIS_BILINEAR, core::SplineBasis::kBilinear},
    {v1::SPLINE_BASIS_BICUBIC_HERMITE, core::SplineBasis::kBicubicHermite},
}};

inline constexpr EnumTable<v1::SurfaceMethod, core::SurfaceMethod, 4>
    kSurfaceMethods{{
        {v1::SURFACE_METHOD_PRODUCTS, core::SurfaceMethod::kProducts},
        {v1::SURFACE_METHOD_ALONG_T, core::SurfaceMethod::kAlongT},
        {v1::SURFACE_METHOD_TWO_FACTORS, core::SurfaceMethod::kTwoFactors},
        {v1::SURFACE_METHOD_TWO_TERMS, core::SurfaceMethod::kTwoTerms},
    }};

inline constexpr EnumTable<v1::Interpolation, core::Interpolation, 3>
    kRasterInterpolations{{
        {v1::INTERPOLATION_CATMULL_ROM, core::Interpolation::kCatmullRom},
        {v1::INTERPOLATION_BILINEAR, core::Interpolation::kBilinear},
        {v1::INTERPOLATION_BSPLINE, core::Interpolation::kBSpline},
    }};

inline constexpr EnumTable<v1::Interpolation, core::Interpolation, 3>
    kProfileInterpolations{{
        {v1::INTERPOLATION_BILINEAR, core::Interpolation::kBilinear},
        {v1::INTERPOLATION_CATMULL_ROM, core::Interpolation::kCatmullRom},
        {v1::INTERPOLATION_BSPLINE, core::Interpolation::kBSpline},
    }};

inline constexpr EnumTable<v1::MacroCombine, core::MacroCombine, 3>
    kMacroCombines{{
        {v1::MACRO_COMBINE_ADD, core::MacroCombine::kAdd},
        {v1::MACRO_COMBINE_MAXIMUM, core::MacroCombine::kMaximum},
        {v1::MACRO_COMBINE_MINIMUM, core::MacroCombine::kMinimum},
    }};

// Unset leaves the choice to the core, so no row stands for it; the first is
// what every recipe may have.
inline constexpr EnumTable<v1::DiscreteMethod, core::DiscreteMethod, 2>
    kDiscreteMethods{{
        {v1::DISCRETE_METHOD_CONDITION, core::DiscreteMethod::kCondition},
        {v1::DISCRETE_METHOD_BUFFER, core::DiscreteMethod::kBuffer},
    }};

// The quantity has no default: an unset one is a violation of its own.
inline constexpr EnumTable<v1::ConstraintQuantity, core::ConstraintQuantity, 2>
    kConstraintQuantities{{
        {v1::CONSTRAINT_QUANTITY_ROUGHNESS,
         core::ConstraintQuantity::kRoughness},
        {v1::CONSTRAINT_QUANTITY_FIDELITY, core::ConstraintQuantity::kFidelity},
    }};

inline constexpr EnumTable<v1::DistanceNorm, core::DistanceNorm, 2>
    kDistanceNorms{{
        {v1::DISTANCE_NORM_L1, core::DistanceNorm::kL1},
        {v1::DISTANCE_NORM_L2, core::DistanceNorm::kL2},
    }};

inline constexpr EnumTable<v1::ReachEdge, core::ReachEdge, 2> kReachEdges{{
    {v1::REACH_EDGE_STEP, core::ReachEdge::kStep},
    {v1::REACH_EDGE_SMOOTH, core::ReachEdge::kSmooth},
}};

inline constexpr EnumTable<v1::Sampling, core::Sampling, 2> kSamplings{{
    {v1::SAMPLING_POINT, core::Sampling::kPoint},
    {v1::SAMPLING_AREA, core::Sampling::kArea},
}};

// The core's value of an enum field. Unset gives the first row; a number that
// the API does not know is a violation.
template <typename Proto, typename Core, std::size_t kSize>
Core ReadEnum(const EnumTable<Proto, Core, kSize>& table, Proto value,
              const core::Path& path, core::Violations* violations) {
  for (const auto& [proto, mapped] : table) {
    if (proto == value) return mapped;
  }
  if (value != 0) {
    violations->Add(path.Text(), "must be a value that the API knows, got " +
                                     std::to_string(static_cast<int>(value)));
  }
  return table.front().second;
}

template <typename Proto, typename Core, std::size_t kSize>
Proto WriteEnum(const EnumTable<Proto, Core, kSize>& table, Core value) {
  for (const auto& [proto, mapped] : table) {
    if (mapped == value) return proto;
  }
  return table.front().first;
}

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_ENUM_TABLE_H_
