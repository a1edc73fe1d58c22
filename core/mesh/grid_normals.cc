#include "core/mesh/grid_normals.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/mesh/grid_normals.cc"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using VF = hn::Vec<DF>;

// Divides a vector by its largest component, so that no product of two leaves
// the range of numbers. The zero vector becomes NaN.
HWY_INLINE void Scale(VF& x, VF& y, VF& z) {
  const VF largest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  const VF inverse = hn::Div(hn::Set(DF(), 1.0f), largest);
  x = hn::Mul(x, inverse);
  y = hn::Mul(y, inverse);
  z = hn::Mul(z, inverse);
}

// a d - b c
HWY_INLINE VF Minor(VF a, VF b, VF c, VF d) {
  return hn::Sub(hn::Mul(a, d), hn::Mul(b, c));
}

// Writes `count` triples, at most a vector of them.
HWY_INLINE void StoreTriples(VF x, VF y, VF z, int count, float* out) {
  const DF df;
  if (count >= static_cast<int>(hn::Lanes(df))) {
    hn::StoreInterleaved3(x, y, z, df, out);
    return;
  }
  HWY_ALIGN float rest[3 * hn::MaxLanes(DF())];
  hn::StoreInterleaved3(x, y, z, df, rest);
  std::copy_n(rest, 3 * count, out);
}

void GridNormals(const VertexRow& before, const VertexRow& row,
                 const VertexRow& after, const Float3& otherwise, int count,
                 float* normals) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  for (int c = 0; c < count; c += lanes) {
    const auto step = [&](const float* high, const float* low) HWY_ATTR {
      return hn::Sub(hn::LoadU(df, high), hn::LoadU(df, low));
    };
    VF tx = step(row.x + c + 1, row.x + c - 1);
    VF ty = step(row.y + c + 1, row.y + c - 1);
    VF tz = step(row.z + c + 1, row.z + c - 1);
    VF ux = step(after.x + c, before.x + c);
    VF uy = step(after.y + c, before.y + c);
    VF uz = step(after.z + c, before.z + c);
    Scale(tx, ty, tz);
    Scale(ux, uy, uz);
    VF nx = Minor(ty, tz, uy, uz);
    VF ny = Minor(tz, tx, uz, ux);
    VF nz = Minor(tx, ty, ux, uy);
    const VF square =
        hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz));
    const VF inverse = hn::Div(hn::Set(df, 1.0f), hn::Sqrt(square));
    // False for NaN, too.
    const auto good = hn::Gt(square, hn::Set(df, 1e-30f));
    nx = hn::IfThenElse(good, hn::Mul(nx, inverse), hn::Set(df, otherwise.x));
    ny = hn::IfThenElse(good, hn::Mul(ny, inverse), hn::Set(df, otherwise.y));
    nz = hn::IfThenElse(good, hn::Mul(nz, inverse), hn::Set(df, otherwise.z));
    StoreTriples(nx, ny, nz, count - c, normals + 3 * c);
  }
}

void InterleaveVertices(const VertexRow& row, int count, float* positions) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  for (int c = 0; c < count; c += lanes) {
    StoreTriples(hn::LoadU(df, row.x + c), hn::LoadU(df, row.y + c),
                 hn::LoadU(df, row.z + c), count - c, positions + 3 * c);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(GridNormals);
HWY_EXPORT(InterleaveVertices);

void GridNormals(const VertexRow& before, const VertexRow& row,
                 const VertexRow& after, const Float3& otherwise, int count,
                 float* normals) {
  HWY_DYNAMIC_DISPATCH(GridNormals)
  (before, row, after, otherwise, count, normals);
}

void InterleaveVertices(const VertexRow& row, int count, float* positions) {
  HWY_DYNAMIC_DISPATCH(InterleaveVertices)(row, count, positions);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
