#include "client/render/relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace terrane::client {
namespace {

constexpr Rgb kNoData{0.93, 0.93, 0.93};

struct TintStop {
  double at;
  Rgb colour;
};
// Muted, so that the shading stays readable on every height.
constexpr std::array<TintStop, 7> kLand = {{
    {0.00, {0.45, 0.60, 0.42}},
    {0.15, {0.60, 0.70, 0.48}},
    {0.35, {0.82, 0.80, 0.58}},
    {0.55, {0.80, 0.68, 0.48}},
    {0.75, {0.66, 0.53, 0.41}},
    {0.90, {0.76, 0.71, 0.67}},
    {1.00, {0.97, 0.97, 0.97}},
}};

constexpr Rgb kShallow{0.55, 0.74, 0.87};
constexpr Rgb kDeep{0.22, 0.42, 0.65};

double Share(double height, const TintRange& range) {
  const double extent = range.maximum - range.minimum;
  return extent > 0 ? std::clamp((height - range.minimum) / extent, 0.0, 1.0)
                    : 0.5;
}

Rgb ColourOf(double height, double shade, const TintRange& range,
             const ReliefOptions& options) {
  if (std::isnan(height)) return kNoData;
  if (options.water_level.has_value() && height < *options.water_level) {
    return WaterTint(*options.water_level - height, range);
  }
  switch (options.style) {
    case ReliefStyle::kRelief:
      return Lit(LandTint(height, range), shade, options.light.up);
    case ReliefStyle::kHillshade:
      return {shade, shade, shade};
    case ReliefStyle::kGrey:
      break;
  }
  const double grey = Share(height, range);
  return {grey, grey, grey};
}

}  // namespace

TintRange TintRangeOf(const core::HeightView& heights,
                      std::optional<double> water_level) {
  TintRange range{std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity()};
  for (const float height : heights.values) {
    if (std::isnan(height)) continue;
    range.minimum = std::min<double>(range.minimum, height);
    range.maximum = std::max<double>(range.maximum, height);
  }
  if (range.minimum > range.maximum) return {0, 1};
  if (water_level.has_value()) {
    range.minimum = std::max(range.minimum, *water_level);
    range.maximum = std::max(range.maximum, *water_level);
  }
  return range;
}

Rgb LandTint(double height, const TintRange& range) {
  const double share = Share(height, range);
  std::size_t above = 1;
  while (above + 1 < kLand.size() && kLand[above].at < share) ++above;
  const TintStop& low = kLand[above - 1];
  const TintStop& high = kLand[above];
  return Mix(low.colour, high.colour, (share - low.at) / (high.at - low.at));
}

Rgb WaterTint(double depth, const TintRange& range) {
  const double extent = std::max(range.maximum - range.minimum, 1e-9);
  // Half way to the deep colour at a tenth of the land's height.
  return Mix(kShallow, kDeep, 1 - 1 / (1 + 10 * depth / extent));
}

Rgb Lit(const Rgb& tint, double shade, double level_shade) {
  // Darker than a plain: towards a bluish shadow; brighter: towards warm white.
  constexpr Rgb kShadow{0.08, 0.09, 0.16};
  constexpr Rgb kSun{1.0, 0.99, 0.94};
  if (shade < level_shade) {
    return Mix(tint, kShadow, 0.85 * (1 - shade / level_shade));
  }
  return Mix(tint, kSun, 0.75 * (shade - level_shade) / (1 - level_shade));
}

Picture RenderRelief(const core::HeightView& heights,
                     const core::GroundScale& scale,
                     const ReliefOptions& options) {
  std::vector<float> shade(heights.values.size());
  core::Hillshade(heights, scale, options.light, options.exaggeration, shade);
  const TintRange range = TintRangeOf(heights, options.water_level);
  Canvas canvas(static_cast<int>(heights.width),
                static_cast<int>(heights.height), kNoData);
  std::size_t at = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x, ++at) {
      canvas.SetPixel(x, y,
                      ColourOf(heights.values[at], shade[at], range, options));
    }
  }
  return canvas.picture();
}

}  // namespace terrane::client
