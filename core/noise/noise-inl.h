// SIMD forms of HashLane and NormalFromBits, for inclusion in Highway kernels
// only (once per target, inside foreach_target).

#if defined(TERRANE_CORE_NOISE_NOISE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TERRANE_CORE_NOISE_NOISE_INL_H_
#undef TERRANE_CORE_NOISE_NOISE_INL_H_
#else
#define TERRANE_CORE_NOISE_NOISE_INL_H_
#endif

#include <cstdint>

#include "core/noise/counter_hash.h"
#include "core/noise/normal.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Bits of the lanes whose column words are `words` in the row of `key`.
template <class DU>
HWY_INLINE hn::Vec<DU> HashLanes(DU du, hn::Vec<DU> words, RowKey key) {
  auto x = hn::Mul(hn::Add(words, hn::Set(du, key.first)),
                   hn::Set(du, kLaneMultiplier1));
  x = hn::Xor(x, hn::ShiftRight<15>(x));
  x = hn::Mul(hn::Xor(x, hn::Set(du, key.second)),
              hn::Set(du, kLaneMultiplier2));
  return hn::Xor(x, hn::ShiftRight<16>(x));
}

// No MulAdd here: targets with and without FMA must round alike.
template <class DF>
HWY_INLINE hn::Vec<DF> NormalFromLanes(DF df,
                                       hn::Vec<hn::RebindToUnsigned<DF>> bits) {
  const hn::RebindToUnsigned<DF> du;
  const hn::RebindToSigned<DF> di;
  const auto halves =
      hn::Add(hn::And(bits, hn::Set(du, 0xFFFFu)), hn::ShiftRight<16>(bits));
  const auto sum = hn::Sub(hn::BitCast(di, halves), hn::Set(di, 65535));
  const auto s = hn::Mul(hn::ConvertTo(df, sum), hn::Set(df, 0x1p-16f));
  const auto s2 = hn::Mul(s, s);
  auto q = hn::Add(hn::Mul(hn::Set(df, kNormal9), s2), hn::Set(df, kNormal7));
  q = hn::Add(hn::Mul(q, s2), hn::Set(df, kNormal5));
  q = hn::Add(hn::Mul(q, s2), hn::Set(df, kNormal3));
  q = hn::Add(hn::Mul(q, s2), hn::Set(df, kNormal1));
  return hn::Mul(s, q);
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#endif  // TERRANE_CORE_NOISE_NOISE_INL_H_
