#include "core/flower/blade_painter.h"

#include <algorithm>
#include <cmath>

#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

constexpr Tint kWhite = {1, 1, 1};
// Rays of a blotch over a quarter turn, and the breadth of its soft edges.
constexpr float kRays = 9;
constexpr float kSoftEdge = 0.06f;

Float3 ToFloat3(const Tint& tint) { return {tint[0], tint[1], tint[2]}; }

Float3 Mix(Float3 a, Float3 b, float share) {
  return (1.0f - share) * a + share * b;
}

// From 0 at `low` to 1 at `high`, level at both.
float SmoothStep(float low, float high, float at) {
  const float t = std::clamp((at - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

}  // namespace

bool HasColors(const BladeColors& colors) {
  return colors.base != kWhite || colors.tip != kWhite ||
         colors.blotch.has_value() || colors.margin_width > 0;
}

Float3 BladePainter::At(float x, float y, float half_width) const {
  // y^p is 1/2 at the middle; (y / (y + m (1 - y))) has that without a power.
  const auto middle = static_cast<float>(colors_.middle);
  const float ratio = middle / (1.0f - middle);
  const float share = y / (y + ratio * (1.0f - y));
  Float3 color = Mix(ToFloat3(colors_.base), ToFloat3(colors_.tip),
                     share * share * (3.0f - 2.0f * share));
  if (colors_.blotch.has_value()) {
    color = Mix(color, ToFloat3(colors_.blotch->tint),
                BlotchShare(*colors_.blotch, x, y));
  }
  if (colors_.margin_width > 0) {
    const float inside = std::min(half_width - std::fabs(x), 1.0f - y);
    const auto width = static_cast<float>(colors_.margin_width);
    color = Mix(ToFloat3(colors_.margin), color, SmoothStep(0, width, inside));
  }
  return color;
}

float BladePainter::BlotchShare(const Blotch& blotch, float x, float y) const {
  const float side = std::fabs(x);
  const float distance = std::sqrt(x * x + y * y);
  const auto from = static_cast<float>(blotch.from);
  auto to = static_cast<float>(blotch.to);
  if (distance > 0 && blotch.rays > 0) {
    // The share of the quarter turn, nearly: 0 along the midrib, 1 across.
    const float direction = side / (side + std::fabs(y));
    const float ray = noise_.At(kRays * direction, 0.5f).value;
    to += (to - from) * static_cast<float>(blotch.rays) * 1.4f * ray;
  }
  const float begins = SmoothStep(from - kSoftEdge, from + kSoftEdge, distance);
  const float ends = SmoothStep(to - kSoftEdge, to + kSoftEdge, distance);
  return (from > 0 ? begins : 1.0f) * (1.0f - ends);
}

}  // namespace terrane::core
