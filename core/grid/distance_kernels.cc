#include "core/grid/distance_kernels.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/grid/distance_kernels.cc"
#include "hwy/foreach_target.h"
//
#include "core/grid/row_vectors-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void LowerToPointL2(const double* x, std::size_t count, double point_x,
                    double gap, double* row) {
  ForEachVector(count, [&](auto d, std::size_t i) HWY_ATTR {
    const auto dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, point_x));
    const auto squared = hn::Add(hn::Mul(dx, dx), hn::Set(d, gap * gap));
    hn::StoreU(hn::Min(hn::LoadU(d, row + i), squared), d, row + i);
  });
}

void LowerToPointL1(const double* x, std::size_t count, double point_x,
                    double gap, double* row) {
  ForEachVector(count, [&](auto d, std::size_t i) HWY_ATTR {
    const auto dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, point_x));
    const auto sum = hn::Add(hn::Abs(dx), hn::Set(d, gap));
    hn::StoreU(hn::Min(hn::LoadU(d, row + i), hn::Mul(sum, sum)), d, row + i);
  });
}

void CutAbove(double limit, std::size_t count, double* row) {
  ForEachVector(count, [&](auto d, std::size_t i) HWY_ATTR {
    const auto infinity = hn::Set(d, std::numeric_limits<double>::infinity());
    const auto value = hn::LoadU(d, row + i);
    const auto above = hn::Gt(value, hn::Set(d, limit));
    hn::StoreU(hn::IfThenElse(above, infinity, value), d, row + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(LowerToPointL2);
HWY_EXPORT(LowerToPointL1);
HWY_EXPORT(CutAbove);

void LowerToPointL2(const double* x, std::size_t count, double point_x,
                    double gap, double* row) {
  HWY_DYNAMIC_DISPATCH(LowerToPointL2)(x, count, point_x, gap, row);
}

void LowerToPointL1(const double* x, std::size_t count, double point_x,
                    double gap, double* row) {
  HWY_DYNAMIC_DISPATCH(LowerToPointL1)(x, count, point_x, gap, row);
}

void CutAbove(double limit, std::size_t count, double* row) {
  HWY_DYNAMIC_DISPATCH(CutAbove)(limit, count, row);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
