// BladeSurface: the surface of a petal or leaf, row by row from base to tip.
//
// Three methods make one (core/flower/blade_rows.h, bezier_rows.h, ifs_rows.h);
// they share the sketch, its outline's parameter t and with it one topology: a
// vertex at the base, rows of columns + 1, a vertex at the tip.
#ifndef TERRANE_CORE_FLOWER_BLADE_SURFACE_H_
#define TERRANE_CORE_FLOWER_BLADE_SURFACE_H_

#include <vector>

#include "core/mesh/mesh.h"

namespace terrane::core {

// Vertices of a row from left to right, and its place in the sketch.
struct BladeRow {
  float y = 0;
  float half_width = 0;
  std::vector<Float3> positions;
  std::vector<Float3> normals;
};

class BladeSurface {
 public:
  virtual ~BladeSurface() = default;

  // Replaces `row` by columns + 1 vertices at the outline's parameter t; by one
  // at its two ends. `columns` is even, t does not fall from call to call.
  virtual void Make(double t, int columns, BladeRow* row) = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_BLADE_SURFACE_H_
