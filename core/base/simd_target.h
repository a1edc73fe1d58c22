// Which SIMD instruction set the kernels use on this CPU. Highway chooses once,
// at the first call; the choice never changes a bit of a result.
#ifndef TERRANE_CORE_BASE_SIMD_TARGET_H_
#define TERRANE_CORE_BASE_SIMD_TARGET_H_

namespace terrane::core {

// Highway's name, such as "AVX3". Static storage; any thread.
const char* SimdTargetName();

}  // namespace terrane::core

#endif  // TERRANE_CORE_BASE_SIMD_TARGET_H_
