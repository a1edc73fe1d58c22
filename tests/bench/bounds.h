// What a sample costs at the very least: the yardsticks of the benches.
#ifndef TERRANE_TESTS_BENCH_BOUNDS_H_
#define TERRANE_TESTS_BENCH_BOUNDS_H_

#include <cstdint>
#include <vector>

namespace terrane::core {

// One normal draw a sample and nothing else, in SIMD like the kernels'. `words`
// and `out` hold whole vectors of 16.
void DrawNormals(std::int64_t seed, const std::vector<std::uint32_t>& words,
                 std::int64_t rows, std::vector<float>* out);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_BENCH_BOUNDS_H_
