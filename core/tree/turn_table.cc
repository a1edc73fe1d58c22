#include "core/tree/turn_table.h"

#include <cstddef>

#include "core/base/det_math.h"

namespace terrane::core {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

TurnTable::TurnTable() {
  constexpr std::size_t kQuarter = 64;
  for (std::size_t i = 0; i < kQuarter; ++i) {
    const double angle = kPi / 2 / kQuarter * static_cast<double>(i);
    const auto sine = static_cast<float>(DetSin(angle));
    const auto cosine = static_cast<float>(DetCos(angle));
    coarse_[i] = {sine, cosine};
    coarse_[i + kQuarter] = {cosine, -sine};
    coarse_[i + 2 * kQuarter] = {-sine, -cosine};
    coarse_[i + 3 * kQuarter] = {-cosine, sine};
  }
}

SineCosine SineCosineOfDegrees(double degrees) {
  const double angle = degrees * (kPi / 180);
  return {static_cast<float>(DetSin(angle)), static_cast<float>(DetCos(angle))};
}

}  // namespace terrane::core
