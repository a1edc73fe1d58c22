#include "core/base/simd_target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/base/simd_target.cc"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
const char* ThisTargetName() { return hwy::TargetName(HWY_TARGET); }
}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {
HWY_EXPORT(ThisTargetName);
const char* SimdTargetName() { return HWY_DYNAMIC_DISPATCH(ThisTargetName)(); }
}  // namespace terrane::core
#endif  // HWY_ONCE
