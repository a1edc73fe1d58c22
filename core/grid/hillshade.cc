#include "core/grid/hillshade.h"

#include <algorithm>
#include <cmath>

namespace terrane::core {
namespace {

// The neighbours of one sample along an axis; at the border one of them is the
// sample itself, and the distance between them is shorter.
struct Neighbours {
  std::int64_t before;
  std::int64_t after;
  // Steps between them; 1 instead of 0 on an axis of one sample, where the
  // difference is 0 anyway.
  double steps;
};

Neighbours NeighboursOf(std::int64_t at, std::int64_t count) {
  const std::int64_t before = std::max<std::int64_t>(at - 1, 0);
  const std::int64_t after = std::min(at + 1, count - 1);
  return {before, after,
          static_cast<double>(std::max<std::int64_t>(after - before, 1))};
}

// Horn's weighted difference over a row or column: (a + 2 b + c) / 4.
double Weighted(double a, double b, double c) { return (a + 2 * b + c) * 0.25; }

float ShadeAt(const HeightView& heights, const GroundSpacing& spacing,
              const Light& light, double exaggeration, std::int64_t i,
              std::int64_t j) {
  const float centre = heights.At(i, j);
  if (std::isnan(centre)) return centre;
  const Neighbours x = NeighboursOf(i, heights.width);
  const Neighbours y = NeighboursOf(j, heights.height);
  const auto at = [&](std::int64_t column, std::int64_t row) -> double {
    const float value = heights.At(column, row);
    return std::isnan(value) ? centre : value;
  };
  const double west =
      Weighted(at(x.before, y.before), at(x.before, j), at(x.before, y.after));
  const double east =
      Weighted(at(x.after, y.before), at(x.after, j), at(x.after, y.after));
  const double north =
      Weighted(at(x.before, y.before), at(i, y.before), at(x.after, y.before));
  const double south =
      Weighted(at(x.before, y.after), at(i, y.after), at(x.after, y.after));
  const double rise_east = exaggeration * (east - west) / (x.steps * spacing.x);
  const double rise_north =
      exaggeration * (north - south) / (y.steps * spacing.y);
  const double cosine =
      (light.up - rise_east * light.east - rise_north * light.north) /
      std::sqrt(1 + rise_east * rise_east + rise_north * rise_north);
  return static_cast<float>(std::clamp(cosine, 0.0, 1.0));
}

}  // namespace

void Hillshade(const HeightView& heights, const GroundScale& scale,
               const Light& light, double exaggeration,
               std::span<float> shade) {
  for (std::int64_t j = 0; j < heights.height; ++j) {
    for (std::int64_t i = 0; i < heights.width; ++i) {
      shade[static_cast<std::size_t>(j * heights.width + i)] =
          ShadeAt(heights, scale.Row(j), light, exaggeration, i, j);
    }
  }
}

}  // namespace terrane::core
