#include "core/terrain/constraint_kernels.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/terrain/constraint_kernels.cc"
#include "hwy/foreach_target.h"
//
#include "core/grid/row_vectors-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Without branches: out of reach adds 0 to both. Without falloff, the default,
// there is nothing to divide by.
template <bool kSmooth, bool kFades>
void AddTerms(const SourceTerm& term, const double* squared_distances,
              std::size_t count, double* pulls, double* shares) {
  ForEachVector(count, [&](auto d, std::size_t i) HWY_ATTR {
    const auto one = hn::Set(d, 1.0);
    const auto distance = hn::LoadU(d, squared_distances + i);
    const auto reaches =
        hn::Ne(distance, hn::Set(d, std::numeric_limits<double>::infinity()));
    const auto within = hn::IfThenElseZero(reaches, distance);
    auto pull = hn::Set(d, term.difference);
    if constexpr (kFades) {
      pull = hn::Div(pull,
                     hn::Add(one, hn::Mul(hn::Set(d, term.falloff), within)));
    }
    auto share = one;
    if constexpr (kSmooth) {
      const auto window =
          hn::Sub(one, hn::Div(within, hn::Set(d, term.square_reach)));
      share = hn::Mul(window, window);
      pull = hn::Mul(pull, share);
    }
    const auto pull_sum =
        hn::Add(hn::LoadU(d, pulls + i), hn::IfThenElseZero(reaches, pull));
    const auto share_sum =
        hn::Add(hn::LoadU(d, shares + i), hn::IfThenElseZero(reaches, share));
    hn::StoreU(pull_sum, d, pulls + i);
    hn::StoreU(share_sum, d, shares + i);
  });
}

void AddSourceTerms(const SourceTerm& term, const double* squared_distances,
                    std::size_t count, double* pulls, double* shares) {
  const bool fades = term.falloff != 0;
  const auto add =
      term.smooth ? (fades ? AddTerms<true, true> : AddTerms<true, false>)
                  : (fades ? AddTerms<false, true> : AddTerms<false, false>);
  add(term, squared_distances, count, pulls, shares);
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(AddSourceTerms);

void AddSourceTerms(const SourceTerm& term, const double* squared_distances,
                    std::size_t count, double* pulls, double* shares) {
  HWY_DYNAMIC_DISPATCH(AddSourceTerms)
  (term, squared_distances, count, pulls, shares);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
