// SurfaceSpec: everything that determines a fractal free-form surface, as plain
// data.
//
// The C++ side of proto/terrane/v1/surface_recipe.proto: same names, same
// units, same defaults; the proto's comments hold the ranges. A spec is only
// data: ValidateSurface (core/surface/validate_surface.h) says what is wrong
// with it, Surface::Create refuses one that is not valid.
//
// Source: Mo, Tan & Zhang, "Adaptive linear neural network based fractal
// generation of free surface", Journal of Software 12, 2001. In the paper's
// symbols: control points P_ij with i along t and j along u, blending functions
// f_i(t) f_j(u), weights w, desired response Y, learning rate mu, K iterations.
#ifndef TERRANE_CORE_SURFACE_SURFACE_SPEC_H_
#define TERRANE_CORE_SURFACE_SURFACE_SPEC_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/spline/basis.h"

namespace terrane::core {

// Revision of the surface algorithm: the same spec and revision give the same
// bytes everywhere. New bytes need a new revision.
inline constexpr int kSurfaceRevision = 1;

struct Point3 {
  double x = 0;
  double y = 0;
  double z = 0;

  bool operator==(const Point3&) const = default;
};

// A tensor-product net (eq. 1). Row j holds the points P_0j .. P_nj.
struct PointNet {
  SplineBasis basis = SplineBasis::kBSplineClamped;
  int degree = 3;   // where HasDegree(basis)
  int columns = 0;  // along t
  int rows = 0;     // along u
  std::vector<Point3> points;

  const Point3& At(int i, int j) const {
    return points[static_cast<std::size_t>(j) *
                      static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(i)];
  }
};

// How the trained weights enter M_ij (eqs. 3-6).
enum class SurfaceMethod {
  kProducts,    // 1: M = f_i f_j w_ij, one network over all products
  kAlongT,      // 2: M = f_i w_i f_j, one network over f_i(t)
  kTwoFactors,  // 3: M = f_i w_i f_j w_j, two networks
  kTwoTerms     // 4: M = f_i f_j (w_i + w_j), two networks
};

// Whether a method has a second network, over f_j(u).
constexpr bool HasNetworkU(SurfaceMethod method) {
  return method == SurfaceMethod::kTwoFactors ||
         method == SurfaceMethod::kTwoTerms;
}

// Initial weights offset + slope_i i + slope_j j + random U, U uniform in
// [0, 1) and drawn anew for every sample, for the weights that are selected.
struct WeightRule {
  std::optional<int> i;  // not set: every i
  std::optional<int> j;  // not set: every j
  double offset = 0;
  double slope_i = 0;
  double slope_j = 0;
  double random = 0;
  // With carry-over: set by the rule at every sample, not carried over.
  bool redraw = false;
};

// One adaline. Weights that no rule selects start at U; of several rules that
// select a weight the last one holds.
struct Network {
  std::vector<WeightRule> weights;
  // Y = desired + desired_random U.
  double desired = 1;
  double desired_random = 0;
};

// LMS training with a limited number of steps; 0 turns training off.
struct Training {
  double learning_rate = 0;
  int iterations = 0;
};

struct SurfaceSpec {
  std::int64_t seed = 0;
  PointNet net;
  SurfaceMethod method = SurfaceMethod::kProducts;
  Network network;    // of the products, or along t
  Network network_u;  // where HasNetworkU(method)
  // Not set: trained to convergence.
  std::optional<Training> training;
  // Networks start from the trained weights of the sample before, along t.
  bool carry_over = false;
  // Where the perturbation goes; of any length but 0.
  Point3 direction = {0, 0, 1};
  // Samples whose perturbed coordinate lies below it are left out.
  std::optional<double> hole_level;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_SURFACE_SPEC_H_
