#include "core/terrain/mapping_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/terrain/mapping_kernels.cc"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::ScalableTag<std::int32_t>;
using VF = hn::Vec<DF>;

// -ln(y) for y in (0, 1]. m in [sqrt(1/2), sqrt(2)) is y over a power of two
// and ln m = 2 atanh(t), t = (m - 1) / (m + 1), |t| < 0.172; t^9 / 9 is the
// last term needed for 24 bits.
HWY_INLINE VF MinusLog(VF y) {
  const DF df;
  const DI di;
  const auto bits = hn::BitCast(di, y);
  // Taking the bits of sqrt(1/2) away first makes the cut at sqrt(2), not at 2.
  const auto shifted = hn::Sub(bits, hn::Set(di, 0x3F3504F3));
  const auto exponent = hn::ShiftRight<23>(shifted);
  const VF m = hn::BitCast(df, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  const VF one = hn::Set(df, 1.0f);
  const VF t = hn::Div(hn::Sub(m, one), hn::Add(m, one));
  const VF t2 = hn::Mul(t, t);
  VF sum = hn::Add(hn::Mul(hn::Set(df, 2.0f / 9), t2), hn::Set(df, 2.0f / 7));
  sum = hn::Add(hn::Mul(sum, t2), hn::Set(df, 2.0f / 5));
  sum = hn::Add(hn::Mul(sum, t2), hn::Set(df, 2.0f / 3));
  sum = hn::Add(hn::Mul(sum, t2), hn::Set(df, 2.0f));
  const VF log_m = hn::Mul(sum, t);
  const VF log_power =
      hn::Mul(hn::ConvertTo(df, exponent), hn::Set(df, 0.693147182f));
  return hn::Neg(hn::Add(log_power, log_m));
}

// -ln(1 - v) for v in [0, 1), exact to rounding near 0, too: 1 - v loses the
// low bits of v, and v / (1 - y) gives them back (Kahan).
HWY_INLINE VF MinusLog1m(VF v) {
  const DF df;
  const VF one = hn::Set(df, 1.0f);
  const VF y = hn::Sub(one, v);
  const VF lost = hn::Sub(one, y);
  const auto tiny = hn::Eq(lost, hn::Zero(df));
  const VF ratio = hn::Div(v, hn::IfThenElse(tiny, one, lost));
  return hn::IfThenElse(tiny, v, hn::Mul(MinusLog(y), ratio));
}

template <bool kBoltzmann, bool kVaries>
void MapLanes(const HeightMap& map, const float* fractal, const float* macro,
              float macro_constant, const float* fidelity, int count,
              float* out) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  const VF uniform = hn::Set(df, map.deviation);
  const VF constant = hn::Set(df, macro_constant);
  const VF inverse_limit = hn::Set(df, map.inverse_soft_limit);
  for (int i = 0; i < count; i += lanes) {
    const VF p = hn::LoadU(df, fractal + i);
    VF deviation = uniform;
    if constexpr (kVaries) deviation = hn::Sqrt(hn::LoadU(df, fidelity + i));
    VF u;
    if constexpr (kBoltzmann) {
      const VF size = hn::Min(hn::Abs(p), hn::Set(df, 2.44948974f));
      const VF log = MinusLog1m(hn::Mul(size, hn::Set(df, map.z)));
      const VF root = hn::Sqrt(hn::Add(log, log));
      u = hn::Mul(hn::CopySign(root, p), deviation);
    } else {
      u = hn::Mul(p, deviation);
      if (map.inverse_soft_limit > 0) {
        const VF r = hn::Mul(u, inverse_limit);
        u = hn::Div(u, hn::Sqrt(hn::Add(hn::Set(df, 1.0f), hn::Mul(r, r))));
      }
    }
    const VF d = macro != nullptr ? hn::LoadU(df, macro + i) : constant;
    const VF height = hn::Add(d, u);
    if (i + lanes <= count) {
      hn::StoreU(height, df, out + i);
    } else {
      const auto rest = hn::FirstN(df, static_cast<std::size_t>(count - i));
      hn::BlendedStore(height, rest, df, out + i);
    }
  }
}

void MapRow(const HeightMap& map, const float* fractal, const float* macro,
            float macro_constant, const float* fidelity, int count,
            float* out) {
  const auto run = [&](auto boltzmann, auto varies) {
    MapLanes<decltype(boltzmann)::value, decltype(varies)::value>(
        map, fractal, macro, macro_constant, fidelity, count, out);
  };
  if (map.mapping == HeightMapping::kBoltzmann) {
    fidelity != nullptr ? run(std::true_type(), std::true_type())
                        : run(std::true_type(), std::false_type());
  } else {
    fidelity != nullptr ? run(std::false_type(), std::true_type())
                        : run(std::false_type(), std::false_type());
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(MapRow);

void MapRow(const HeightMap& map, const float* fractal, const float* macro,
            float macro_constant, const float* fidelity, int count,
            float* out) {
  HWY_DYNAMIC_DISPATCH(MapRow)
  (map, fractal, macro, macro_constant, fidelity, count, out);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
