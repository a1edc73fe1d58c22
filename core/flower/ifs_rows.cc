#include "core/flower/ifs_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/noise/counter_hash.h"

namespace terrane::core {
namespace {

constexpr std::uint32_t kIfsStream = 0x49465320;
// Above 1/2 the images of neighbouring maps overlap.
constexpr double kContraction = 0.6;
constexpr int kLeastPoints = 8'192;
constexpr int kPointsOfRow = 64;
// Before the game is close to the attractor.
constexpr int kSkipped = 32;

AffineMap Towards(double x, double y) {
  return {kContraction,          0, 0, kContraction, (1 - kContraction) * x,
          (1 - kContraction) * y};
}

}  // namespace

std::vector<AffineMap> IfsCode(const Sketch& sketch) {
  std::vector<AffineMap> code = {Towards(0, 0), Towards(0, 1)};
  for (const SketchPoint& point : sketch.points) {
    code.push_back(Towards(point.x, point.y));
    code.push_back(Towards(-point.x, point.y));
  }
  return code;
}

IfsRows::IfsRows(const std::vector<AffineMap>& code, int rows, int spans,
                 std::int64_t seed)
    : spans_(spans), half_widths_(static_cast<std::size_t>(rows) + 1) {
  const RowKey key = MakeRowKey(StreamKey(seed, kIfsStream), 0);
  const int points = std::max(kLeastPoints, kPointsOfRow * rows);
  double x = 0;
  double y = 0;
  for (int i = -kSkipped; i < points; ++i) {
    const std::uint64_t word = HashLane(ColumnWord(i), key);
    const AffineMap& map = code[(word * code.size()) >> 32];
    const double next = map.a * x + map.b * y + map.e;
    y = map.c * x + map.d * y + map.f;
    x = next;
    if (i < 0) continue;
    const double place = std::clamp(y * rows + 0.5, 0.0, rows + 0.5);
    float& reach = half_widths_[static_cast<std::size_t>(place)];
    reach = std::max(reach, static_cast<float>(std::fabs(x)));
  }
  // Base and tip are points; rows that no point fell into lie between others.
  half_widths_.front() = 0;
  half_widths_.back() = 0;
  std::size_t before = 0;
  for (std::size_t i = 1; i < half_widths_.size(); ++i) {
    if (half_widths_[i] <= 0 && i + 1 < half_widths_.size()) continue;
    const float rise = (half_widths_[i] - half_widths_[before]) /
                       static_cast<float>(i - before);
    for (std::size_t k = before + 1; k < i; ++k) {
      half_widths_[k] =
          half_widths_[before] + rise * static_cast<float>(k - before);
    }
    before = i;
  }
}

void IfsRows::Make(double t, int columns, BladeRow* row) {
  const double along = t / spans_;
  const auto last = static_cast<double>(half_widths_.size() - 1);
  const auto index = static_cast<std::size_t>(std::nearbyint(along * last));
  const bool is_point = index == 0 || index + 1 == half_widths_.size();
  row->y = static_cast<float>(along);
  row->half_width = half_widths_[index];
  const int half = is_point ? 0 : columns / 2;
  row->positions.clear();
  row->normals.clear();
  for (int k = -half; k <= half; ++k) {
    const float share =
        half > 0 ? static_cast<float>(k) / static_cast<float>(half) : 0.0f;
    row->positions.push_back({share * row->half_width, row->y, 0});
    row->normals.push_back({0, 0, 1});
  }
}

}  // namespace terrane::core
