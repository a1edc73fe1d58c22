// IfsRows: a petal as the attractor of an iterated function system, the fractal
// method that the paper compares with.
//
// The code has one map for each of the sketch's points, their mirror images,
// base and tip: w(p) = s p + (1 - s) f, f the point (6 numbers a map as a, b,
// c, d, e, f). Its attractor fills their convex hull. Points of it, found by
// the chaos game, are triangulated: each row reaches as far as the points
// around it. Such a petal is flat, it has neither relief nor curl.
//
// Belongs to one thread. Integer draws and IEEE operations only.
#ifndef TERRANE_CORE_FLOWER_IFS_ROWS_H_
#define TERRANE_CORE_FLOWER_IFS_ROWS_H_

#include <cstdint>
#include <vector>

#include "core/flower/blade_surface.h"
#include "core/flower/flower_spec.h"

namespace terrane::core {

// x -> a x + b y + e, y -> c x + d y + f.
struct AffineMap {
  double a = 0, b = 0, c = 0, d = 0, e = 0, f = 0;
};

// The code of a sketch.
std::vector<AffineMap> IfsCode(const Sketch& sketch);

class IfsRows final : public BladeSurface {
 public:
  // A petal of `rows` rows; `spans` of the outline's parameter are its length.
  IfsRows(const std::vector<AffineMap>& code, int rows, int spans,
          std::int64_t seed);

  void Make(double t, int columns, BladeRow* row) override;

 private:
  const int spans_;
  std::vector<float> half_widths_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_IFS_ROWS_H_
