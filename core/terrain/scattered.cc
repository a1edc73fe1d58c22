#include "core/terrain/scattered.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "core/base/violations.h"
#include "core/terrain/spec_checks.h"

namespace terrane::core {
namespace {

// Lattice cells a side of the blocks that points are grouped by.
constexpr int kBlockBits = 6;

struct AxisPlace {
  double index = 0;  // whole lattice index at or before the position
  double along = 0;  // share of the way to the next
};

// A position that is a lattice point's own world coordinate gets exactly that
// point, whatever the division rounds to.
AxisPlace PlaceOnAxis(double position, double origin, double spacing,
                      int level) {
  const double exact = std::ldexp((position - origin) / spacing, level);
  const double nearest = std::nearbyint(exact);
  if (origin + std::ldexp(nearest, -level) * spacing == position) {
    return {nearest, 0};
  }
  const double floor = std::floor(exact);
  return {floor, exact - floor};
}

absl::Status PlacePoints(const Terrain& terrain, int level,
                         std::span<const Point2> points,
                         std::vector<ScatteredPoint>* placed) {
  const Frame& frame = *terrain.spec().frame;
  const std::optional<Window> extent = terrain.Extent(level, Sampling::kPoint);
  Violations violations;
  placed->clear();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string path = "points[" + std::to_string(k) + "]";
    const auto place = [&](const char* name, double position, double origin,
                           double spacing, std::int64_t count) {
      const AxisPlace at = PlaceOnAxis(position, origin, spacing, level);
      const auto limit = static_cast<double>(kMaxIndex - 1);
      const double low = extent ? 0.0 : -limit;
      const double high =
          extent ? std::min(static_cast<double>(count - 1), limit) : limit;
      if (!(at.index >= low && at.index + at.along <= high)) {
        const auto world = [&](double index) {
          return origin + std::ldexp(index, -level) * spacing;
        };
        const auto [first, last] = std::minmax({world(low), world(high)});
        violations.Add(path + name, "must be in " + Range{first, last}.Text() +
                                        ", got " + NumberText(position));
        return AxisPlace();
      }
      return at;
    };
    const AxisPlace x = place(".x", points[k].x, frame.origin_x,
                              frame.spacing_x, extent ? extent->width : 0);
    const AxisPlace y = place(".y", points[k].y, frame.origin_y,
                              frame.spacing_y, extent ? extent->height : 0);
    placed->push_back({static_cast<std::int64_t>(x.index),
                       static_cast<std::int64_t>(y.index), x.along, y.along,
                       static_cast<std::uint32_t>(k)});
  }
  return violations.ToStatus();
}

// a at 0, b at 1; a value with no weight does not count, not even when it is
// NaN.
float Between(float a, float b, double along) {
  if (along == 0) return a;
  return static_cast<float>((1 - along) * static_cast<double>(a) +
                            along * static_cast<double>(b));
}

// The window of samples that a group of points needs.
Window WindowOf(std::span<const ScatteredPoint> group) {
  std::int64_t x1 = group.front().x;
  std::int64_t y1 = group.front().y;
  std::int64_t x0 = x1;
  std::int64_t y0 = y1;
  for (const ScatteredPoint& p : group) {
    x0 = std::min(x0, p.x);
    y0 = std::min(y0, p.y);
    x1 = std::max(x1, p.x + (p.along_x > 0 ? 1 : 0));
    y1 = std::max(y1, p.y + (p.along_y > 0 ? 1 : 0));
  }
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

}  // namespace

absl::Status GenerateScattered(const Terrain& terrain, int level,
                               std::span<const Point2> points,
                               const std::stop_token& stop,
                               TileScratch* scratch,
                               ScatteredScratch* scattered,
                               std::span<float> out) {
  if (terrain.spec().dimensions != 2) {
    return ViolationError("terrain", "must be a 2-D recipe, got dimensions 1");
  }
  if (level < 0 || level > kMaxLevel) {
    return ViolationError("level", "must be in [0, " +
                                       std::to_string(kMaxLevel) + "], got " +
                                       std::to_string(level));
  }
  std::vector<ScatteredPoint>& placed = scattered->points;
  absl::Status status = PlacePoints(terrain, level, points, &placed);
  if (!status.ok()) return status;
  const auto block_of = [](const ScatteredPoint& p) {
    return std::pair(p.y >> kBlockBits, p.x >> kBlockBits);
  };
  std::sort(placed.begin(), placed.end(), [&](const auto& a, const auto& b) {
    return std::tuple(block_of(a), a.id) < std::tuple(block_of(b), b.id);
  });
  for (auto begin = placed.begin(); begin != placed.end();) {
    const auto end = std::find_if(begin, placed.end(), [&](const auto& p) {
      return block_of(p) != block_of(*begin);
    });
    const Window window = WindowOf({begin, end});
    std::vector<float>& heights = scattered->heights;
    heights.resize(static_cast<std::size_t>(window.width * window.height));
    status = terrain.Generate({level, Sampling::kPoint, window}, stop, scratch,
                              heights);
    if (!status.ok()) return status;
    for (; begin != end; ++begin) {
      const auto at = [&](std::int64_t x, std::int64_t y) {
        const std::int64_t i = std::min(x - window.x, window.width - 1);
        const std::int64_t j = std::min(y - window.y, window.height - 1);
        return heights[static_cast<std::size_t>(j * window.width + i)];
      };
      const ScatteredPoint& p = *begin;
      out[p.id] =
          Between(Between(at(p.x, p.y), at(p.x + 1, p.y), p.along_x),
                  Between(at(p.x, p.y + 1), at(p.x + 1, p.y + 1), p.along_x),
                  p.along_y);
    }
  }
  return absl::OkStatus();
}

}  // namespace terrane::core
