#include "core/terrain/lattice_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/terrain/lattice_kernels.cc"
#include "hwy/foreach_target.h"
//
#include "core/noise/noise-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DU = hn::ScalableTag<std::uint32_t>;
using VF = hn::Vec<DF>;

constexpr float kInner = 9.0f / 16;  // weights of the four-point stencil
constexpr float kOuter = 1.0f / 16;

HWY_INLINE VF Load(const float* p) { return hn::LoadU(DF(), p); }

// The displacement of the lanes that start at column i.
template <bool kVaries>
HWY_INLINE VF Displacement(const std::uint32_t* words, RowKey key, VF uniform,
                           const float* per_point, std::ptrdiff_t i) {
  const DF df;
  const DU du;
  const VF normal =
      NormalFromLanes(df, HashLanes(du, hn::LoadU(du, words + i), key));
  if constexpr (kVaries) return hn::Mul(normal, Load(per_point + i));
  return hn::Mul(normal, uniform);
}

// Row of `deviation`, or nothing when it is uniform.
HWY_INLINE const float* RowOf(const Deviation& deviation, std::ptrdiff_t j) {
  return deviation.varies() ? deviation.per_point.Row(j) : nullptr;
}

// (-1, 9, 9, -1) / 16 over four values.
HWY_INLINE VF FourPoint(VF a, VF b, VF c, VF d) {
  const DF df;
  return hn::Sub(hn::Mul(hn::Add(b, c), hn::Set(df, kInner)),
                 hn::Mul(hn::Add(a, d), hn::Set(df, kOuter)));
}

// --- Centres ----------------------------------------------------------------

template <bool kVaries>
void MidpointCentres(const CentreStep& s) {
  const DF df;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(df));
  const VF uniform = hn::Set(df, s.deviation.uniform);
  for (std::ptrdiff_t j = s.first_row; j < s.last_row; ++j) {
    const float* c0 = s.parent.Row(j);
    const float* c1 = s.parent.Row(j + 1);
    const float* per_point = RowOf(s.deviation, j);
    float* out = s.centres.Row(j);
    for (std::ptrdiff_t i = s.first_column; i < s.last_column; i += lanes) {
      const VF sum = hn::Add(hn::Add(Load(c0 + i), Load(c0 + i + 1)),
                             hn::Add(Load(c1 + i), Load(c1 + i + 1)));
      const VF noise =
          Displacement<kVaries>(s.words, s.keys[j], uniform, per_point, i);
      hn::StoreU(hn::Add(hn::Mul(sum, hn::Set(df, 0.25f)), noise), df, out + i);
    }
  }
}

// The stencil is separable: rows first, into a ring of four, then columns.
template <bool kVaries>
void SubdivisionCentres(const CentreStep& s) {
  const DF df;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(df));
  const VF uniform = hn::Set(df, s.deviation.uniform);
  const auto ring = [&s](std::ptrdiff_t j) {
    return s.row_scratch + (j & 3) * s.parent.stride;
  };
  const auto filter_row = [&](std::ptrdiff_t j) {
    const float* c = s.parent.Row(j);
    float* out = ring(j);
    for (std::ptrdiff_t i = s.first_column; i < s.last_column; i += lanes) {
      hn::StoreU(FourPoint(Load(c + i - 1), Load(c + i), Load(c + i + 1),
                           Load(c + i + 2)),
                 df, out + i);
    }
  };
  for (std::ptrdiff_t j = s.first_row - 1; j < s.first_row + 2; ++j) {
    filter_row(j);
  }
  for (std::ptrdiff_t j = s.first_row; j < s.last_row; ++j) {
    filter_row(j + 2);
    const float* r0 = ring(j - 1);
    const float* r1 = ring(j);
    const float* r2 = ring(j + 1);
    const float* r3 = ring(j + 2);
    const float* per_point = RowOf(s.deviation, j);
    float* out = s.centres.Row(j);
    for (std::ptrdiff_t i = s.first_column; i < s.last_column; i += lanes) {
      const VF mean =
          FourPoint(Load(r0 + i), Load(r1 + i), Load(r2 + i), Load(r3 + i));
      const VF noise =
          Displacement<kVaries>(s.words, s.keys[j], uniform, per_point, i);
      hn::StoreU(hn::Add(mean, noise), df, out + i);
    }
  }
}

void ComputeCentres(const CentreStep& s) {
  const bool varies = s.deviation.varies();
  if (s.stencil == Stencil::kMidpoint) {
    varies ? MidpointCentres<true>(s) : MidpointCentres<false>(s);
  } else {
    varies ? SubdivisionCentres<true>(s) : SubdivisionCentres<false>(s);
  }
}

// --- Edges ------------------------------------------------------------------

// Rows of corners and centres around cell row j.
struct EdgeRows {
  const float *c_before, *c, *c_after, *c_after2;
  const float *m_before2, *m_before, *m, *m_after;
};

// Weights 81, -9, 1 (over 256) of the turned stencil, for the sums of the 4, 8
// and 4 points that bear them.
HWY_INLINE VF TurnedStencil(VF near, VF middle, VF far) {
  const DF df;
  return hn::Add(hn::Sub(hn::Mul(near, hn::Set(df, 81.0f / 256)),
                         hn::Mul(middle, hn::Set(df, 9.0f / 256))),
                 hn::Mul(far, hn::Set(df, 1.0f / 256)));
}

template <Stencil kStencil>
HWY_INLINE VF HorizontalMean(const EdgeRows& r, std::ptrdiff_t i) {
  const VF near = hn::Add(hn::Add(Load(r.c + i), Load(r.c + i + 1)),
                          hn::Add(Load(r.m_before + i), Load(r.m + i)));
  if constexpr (kStencil == Stencil::kMidpoint) {
    return hn::Mul(near, hn::Set(DF(), 0.25f));
  } else {
    const VF corners =
        hn::Add(hn::Add(Load(r.c_before + i), Load(r.c_before + i + 1)),
                hn::Add(Load(r.c_after + i), Load(r.c_after + i + 1)));
    const VF centres =
        hn::Add(hn::Add(Load(r.m_before + i - 1), Load(r.m_before + i + 1)),
                hn::Add(Load(r.m + i - 1), Load(r.m + i + 1)));
    const VF far = hn::Add(hn::Add(Load(r.c + i - 1), Load(r.c + i + 2)),
                           hn::Add(Load(r.m_before2 + i), Load(r.m_after + i)));
    return TurnedStencil(near, hn::Add(corners, centres), far);
  }
}

template <Stencil kStencil>
HWY_INLINE VF VerticalMean(const EdgeRows& r, std::ptrdiff_t i) {
  const VF near = hn::Add(hn::Add(Load(r.c + i), Load(r.c_after + i)),
                          hn::Add(Load(r.m + i - 1), Load(r.m + i)));
  if constexpr (kStencil == Stencil::kMidpoint) {
    return hn::Mul(near, hn::Set(DF(), 0.25f));
  } else {
    const VF corners =
        hn::Add(hn::Add(Load(r.c + i - 1), Load(r.c + i + 1)),
                hn::Add(Load(r.c_after + i - 1), Load(r.c_after + i + 1)));
    const VF centres =
        hn::Add(hn::Add(Load(r.m_before + i - 1), Load(r.m_before + i)),
                hn::Add(Load(r.m_after + i - 1), Load(r.m_after + i)));
    const VF far = hn::Add(hn::Add(Load(r.c_before + i), Load(r.c_after2 + i)),
                           hn::Add(Load(r.m + i - 2), Load(r.m + i + 1)));
    return TurnedStencil(near, hn::Add(corners, centres), far);
  }
}

// `kDisplaceAll` is only asked for with the midpoint stencil.
template <Stencil kStencil, bool kVaries, bool kDisplaceAll>
void Edges(const EdgeStep& s) {
  const DF df;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(df));
  const VF h_uniform = hn::Set(df, s.horizontal.uniform);
  const VF v_uniform = hn::Set(df, s.vertical.uniform);
  const VF c_uniform = hn::Set(df, s.corner.uniform);
  const VF m_uniform = hn::Set(df, s.centre.uniform);
  constexpr bool kWide = kStencil == Stencil::kSubdivision;
  for (std::ptrdiff_t j = s.first_row; j < s.last_row; ++j) {
    const EdgeRows r = {s.parent.Row(kWide ? j - 1 : j),
                        s.parent.Row(j),
                        s.parent.Row(j + 1),
                        s.parent.Row(kWide ? j + 2 : j),
                        s.centres.Row(kWide ? j - 2 : j),
                        s.centres.Row(j - 1),
                        s.centres.Row(j),
                        s.centres.Row(kWide ? j + 1 : j)};
    const float* h_row = RowOf(s.horizontal, j);
    const float* v_row = RowOf(s.vertical, j);
    float* even_row = s.child.Row(2 * (j - s.first_row));
    float* odd_row = s.child.Row(2 * (j - s.first_row) + 1);
    for (std::ptrdiff_t i = s.first_column; i < s.last_column; i += lanes) {
      const VF h = hn::Add(HorizontalMean<kStencil>(r, i),
                           Displacement<kVaries>(s.odd_words, s.even_keys[j],
                                                 h_uniform, h_row, i));
      const VF v = hn::Add(VerticalMean<kStencil>(r, i),
                           Displacement<kVaries>(s.even_words, s.odd_keys[j],
                                                 v_uniform, v_row, i));
      VF c = Load(r.c + i);
      VF m = Load(r.m + i);
      if constexpr (kDisplaceAll) {
        c = hn::Add(c, Displacement<kVaries>(s.even_words, s.even_keys[j],
                                             c_uniform, RowOf(s.corner, j), i));
        m = hn::Add(m, Displacement<kVaries>(s.odd_words, s.odd_keys[j],
                                             m_uniform, RowOf(s.centre, j), i));
      }
      const std::ptrdiff_t column = 2 * (i - s.first_column);
      hn::StoreInterleaved2(c, h, df, even_row + column);
      hn::StoreInterleaved2(v, m, df, odd_row + column);
    }
  }
}

void ComputeEdges(const EdgeStep& s) {
  const bool varies = s.horizontal.varies();
  if (s.stencil == Stencil::kSubdivision) {
    varies ? Edges<Stencil::kSubdivision, true, false>(s)
           : Edges<Stencil::kSubdivision, false, false>(s);
  } else if (s.displace_all) {
    varies ? Edges<Stencil::kMidpoint, true, true>(s)
           : Edges<Stencil::kMidpoint, false, true>(s);
  } else {
    varies ? Edges<Stencil::kMidpoint, true, false>(s)
           : Edges<Stencil::kMidpoint, false, false>(s);
  }
}

// --- Displacing in place ----------------------------------------------------

template <bool kVaries>
void AddDisplacementsTo(GridView plane, int columns, int rows,
                        const std::uint32_t* words, const RowKey* keys,
                        const Deviation& deviation) {
  const DF df;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(df));
  const VF uniform = hn::Set(df, deviation.uniform);
  for (std::ptrdiff_t j = 0; j < rows; ++j) {
    const float* per_point = RowOf(deviation, j);
    float* row = plane.Row(j);
    for (std::ptrdiff_t i = 0; i < columns; i += lanes) {
      const VF noise =
          Displacement<kVaries>(words, keys[j], uniform, per_point, i);
      hn::StoreU(hn::Add(Load(row + i), noise), df, row + i);
    }
  }
}

void AddDisplacements(GridView plane, int columns, int rows,
                      const std::uint32_t* words, const RowKey* keys,
                      const Deviation& deviation) {
  deviation.varies()
      ? AddDisplacementsTo<true>(plane, columns, rows, words, keys, deviation)
      : AddDisplacementsTo<false>(plane, columns, rows, words, keys, deviation);
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(ComputeCentres);
HWY_EXPORT(ComputeEdges);
HWY_EXPORT(AddDisplacements);

void ComputeCentres(const CentreStep& step) {
  HWY_DYNAMIC_DISPATCH(ComputeCentres)(step);
}

void ComputeEdges(const EdgeStep& step) {
  HWY_DYNAMIC_DISPATCH(ComputeEdges)(step);
}

void AddDisplacements(GridView plane, int columns, int rows,
                      const std::uint32_t* words, const RowKey* keys,
                      const Deviation& deviation) {
  HWY_DYNAMIC_DISPATCH(AddDisplacements)
  (plane, columns, rows, words, keys, deviation);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
