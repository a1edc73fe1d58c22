#include "tests/bench/bounds.h"

#include "core/noise/counter_hash.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/bounds.cc"
#include "hwy/foreach_target.h"
//
#include "core/noise/noise-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void DrawNormals(std::int64_t seed, const std::vector<std::uint32_t>& words,
                 std::int64_t rows, std::vector<float>* out) {
  const hn::ScalableTag<std::uint32_t> du;
  const hn::ScalableTag<float> df;
  const std::uint64_t stream = StreamKey(seed, 40);
  float* row = out->data();
  for (std::int64_t j = 0; j < rows; ++j, row += words.size()) {
    const RowKey key = MakeRowKey(stream, j);
    for (std::size_t i = 0; i < words.size(); i += hn::Lanes(df)) {
      const auto bits = HashLanes(du, hn::LoadU(du, words.data() + i), key);
      hn::StoreU(NormalFromLanes(df, bits), df, row + i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(DrawNormals);

void DrawNormals(std::int64_t seed, const std::vector<std::uint32_t>& words,
                 std::int64_t rows, std::vector<float>* out) {
  HWY_DYNAMIC_DISPATCH(DrawNormals)(seed, words, rows, out);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
