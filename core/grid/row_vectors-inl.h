// Running over a row of doubles in vectors, for inclusion in Highway kernels
// only (once per target, inside foreach_target).

#if defined(TERRANE_CORE_GRID_ROW_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TERRANE_CORE_GRID_ROW_VECTORS_INL_H_
#undef TERRANE_CORE_GRID_ROW_VECTORS_INL_H_
#else
#define TERRANE_CORE_GRID_ROW_VECTORS_INL_H_
#endif

#include <cstddef>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls step(d, i) for the vector of tag d at column i: whole vectors first,
// then the rest of the row one by one.
template <class Step>
HWY_INLINE void ForEachVector(std::size_t count, const Step& step) {
  const hn::ScalableTag<double> wide;
  const hn::CappedTag<double, 1> single;
  std::size_t i = 0;
  for (; i + hn::Lanes(wide) <= count; i += hn::Lanes(wide)) step(wide, i);
  for (; i < count; ++i) step(single, i);
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#endif  // TERRANE_CORE_GRID_ROW_VECTORS_INL_H_
