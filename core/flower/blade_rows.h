// BladeRows: a petal's surface, row by row from its base to its tip.
//
// The flat sheet over the sketch has the depth
//   z(x, y) = k Nd noise(Nsx x, Nsy y) - flare s^3,
//   s = ((x / widest)^2 + y^2) / farthest,
// x replaced by |x| where the relief is mirrored. It is then bent: the midline
// turns by theta(y) = base y + (tip - base) y^2 / 2 in the plane x = 0, and
// across it every row is an arc of curvature `across`. With alpha = across x,
// the midline M, its normal n and X = (1, 0, 0):
//   P = M + (sin(alpha) / across - z sin(alpha)) X
//         + ((1 - cos(alpha)) / across + z cos(alpha)) n,
// and the normals are the cross products of its derivatives, not differences.
// The noise is 0 at the base, wherever whole lattice offsets put it.
//
// Belongs to one thread; the noise is shared. Float32 along a row, the same
// bits on every target: loops without a sum over lanes, polynomials for sine
// and cosine.
//
// Source: Wang, Zhang & Yang 2019, eqs. 4-9; the bending is ours.
#ifndef TERRANE_CORE_FLOWER_BLADE_ROWS_H_
#define TERRANE_CORE_FLOWER_BLADE_ROWS_H_

#include <cstddef>
#include <vector>

#include "core/flower/blade_outline.h"
#include "core/flower/blade_surface.h"
#include "core/flower/flower_spec.h"
#include "core/mesh/mesh.h"
#include "core/noise/perlin_noise.h"

namespace terrane::core {

// Where in the noise a petal lies.
struct LatticeOffset {
  int x = 0;
  int y = 0;
};

class BladeRows final : public BladeSurface {
 public:
  // `noise` and `outline` outlive it. Half a row turns by 180 degrees at most:
  // |across_deg| * widest <= 180.
  BladeRows(const PerlinNoise& noise, const BladeOutline& outline,
            const Relief& relief, const BladeShape& shape,
            LatticeOffset offset);

  void Make(double t, int columns, BladeRow* row) override;

 private:
  // The midline at `y_`.
  struct Midline {
    double y = 0;  // along it
    double out = 0;
    double up = 0;
    double sine = 0;  // of theta
    double cosine = 1;
    double curvature = 0;
  };

  // One number a vertex.
  struct Columns {
    void Resize(std::size_t count);

    std::vector<float> x;
    std::vector<float> cell;  // distance from the lattice column to the left
    std::vector<LatticeColumn> left;
    std::vector<LatticeColumn> right;
    std::vector<float> depth, depth_dx, depth_dy;
    std::vector<Float3> positions;
    std::vector<Float3> normals;
  };

  double Theta(double y) const;
  void MoveTo(double y);
  void PlaceColumns(float y, float half_width, int first, int half);
  void RaiseColumns(float y, std::size_t count);
  void BendColumns(std::size_t count);
  void Store(int half, BladeRow* row) const;

  const PerlinNoise& noise_;
  const BladeOutline& outline_;
  const LatticeOffset offset_;
  const bool mirrored_;
  const float frequency_x_;
  const float frequency_y_;
  const float height_;  // k Nd
  const float flare_;
  const float widest_;
  const float farthest_;
  const float across_;      // radians a unit
  const double base_curl_;  // the same
  const double curl_change_;
  Midline midline_;
  Columns columns_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_BLADE_ROWS_H_
