// BezierRows: a petal as one bicubic Bezier patch, the method of control points
// that the paper compares with.
//
// Its 16 control points (48 numbers) are those of the patch that meets the
// noise petal at 4 x 4 parameters; the rows of the net at base and tip are one
// point each. Normals are the cross products of the patch's derivatives.
//
// Belongs to one thread. Double precision, IEEE operations only.
#ifndef TERRANE_CORE_FLOWER_BEZIER_ROWS_H_
#define TERRANE_CORE_FLOWER_BEZIER_ROWS_H_

#include <array>

#include "core/flower/blade_outline.h"
#include "core/flower/blade_rows.h"
#include "core/flower/blade_surface.h"
#include "core/flower/rotation.h"

namespace terrane::core {

// Control points along and across.
using BezierNet = std::array<std::array<Vector, 4>, 4>;

// The net whose patch meets `petal` at thirds of both parameters. `petal` has
// made no row yet.
BezierNet FitBezierNet(const BladeOutline& outline, BladeRows* petal);

class BezierRows final : public BladeSurface {
 public:
  // `outline` outlives it.
  BezierRows(const BladeOutline& outline, const BezierNet& net);

  void Make(double t, int columns, BladeRow* row) override;

 private:
  const BladeOutline& outline_;
  const BezierNet net_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_BEZIER_ROWS_H_
