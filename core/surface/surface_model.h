// SurfaceModel: a valid SurfaceSpec taken apart for generation.
//
// A control point is split along the unit direction d of the perturbation:
// P = flat + height d. Only the heights are blended with M_ij (step 3 of the
// paper's section 1); the flat parts come from the regular surface. Immutable;
// safe from any thread.
#ifndef TERRANE_CORE_SURFACE_SURFACE_MODEL_H_
#define TERRANE_CORE_SURFACE_SURFACE_MODEL_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/spline/basis.h"
#include "core/surface/surface_spec.h"
#include "core/surface/weight_table.h"

namespace terrane::core {

// Samples of the whole parameter square: t = it / (columns - 1), it < columns;
// u = iu / (rows - 1), iu < rows.
struct SurfaceGrid {
  std::int64_t columns = 0;
  std::int64_t rows = 0;

  bool operator==(const SurfaceGrid&) const = default;
};

// Parameter of sample `index` of `count`.
inline double GridParameter(std::int64_t index, std::int64_t count) {
  return static_cast<double>(index) / static_cast<double>(count - 1);
}

struct SurfaceModel {
  explicit SurfaceModel(const SurfaceSpec& valid);

  double Height(int i, int j) const {
    return heights[static_cast<std::size_t>(j * spec.net.columns + i)];
  }
  const Point3& Flat(int i, int j) const {
    return flats[static_cast<std::size_t>(j * spec.net.columns + i)];
  }

  SurfaceSpec spec;
  Point3 direction;  // unit vector
  Basis along_t;
  Basis along_u;
  std::vector<double> heights;
  std::vector<Point3> flats;
  WeightTable network;    // over products: columns i, rows j; else over i
  WeightTable network_u;  // over j
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_SURFACE_MODEL_H_
