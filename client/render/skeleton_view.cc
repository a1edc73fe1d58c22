#include "client/render/skeleton_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace terrane::client {
namespace {

constexpr double kMarginShare = 0.04;
constexpr double kThinnest = 0.75;  // pixels
// Drawn larger and shrunk, so that thin twigs are seen.
constexpr int kOversampling = 2;
// Of a Cantor set's bars, as shares of the first one's length; and their
// largest radius as a share of their own, so that round ends stay apart.
constexpr float kBarStep = 0.09f;
constexpr float kBarRadius = 0.018f;
constexpr float kBarRadiusOfOwn = 0.3f;

// From the plane y = 0 to pixels.
class Projection {
 public:
  Projection(const core::SegmentBlock& tree, int size) {
    for (std::size_t row = 0; row < tree.rows(); ++row) {
      Include(tree.start[row], tree.radius_start[row]);
      Include(tree.end[row], tree.radius_end[row]);
    }
    const double extent = std::max({right_ - left_, top_ - bottom_, 1e-30});
    scale_ = size * (1 - 2 * kMarginShare) / extent;
    middle_ = size / 2.0;
  }

  PixelPoint Project(const core::Float3& p) const {
    const double x = static_cast<double>(p.x) - (left_ + right_) / 2;
    const double z = static_cast<double>(p.z) - (bottom_ + top_) / 2;
    return {middle_ + scale_ * x, middle_ - scale_ * z};
  }

  double Width(float radius) const {
    return 2 * scale_ * static_cast<double>(radius);
  }

 private:
  void Include(const core::Float3& p, float radius) {
    const auto x = static_cast<double>(p.x);
    const auto z = static_cast<double>(p.z);
    const auto r = static_cast<double>(radius);
    left_ = std::min(left_, x - r);
    right_ = std::max(right_, x + r);
    bottom_ = std::min(bottom_, z - r);
    top_ = std::max(top_, z + r);
  }

  double left_ = std::numeric_limits<double>::infinity();
  double right_ = -left_;
  double bottom_ = left_;
  double top_ = -left_;
  double scale_;
  double middle_;
};

}  // namespace

Picture DrawSkeleton(const core::SegmentBlock& tree, int size,
                     const Rgb& colour) {
  const int drawn_size = size * kOversampling;
  const Projection projection(tree, drawn_size);
  Canvas canvas(drawn_size, drawn_size, {1, 1, 1});
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    const PixelPoint start = projection.Project(tree.start[row]);
    const PixelPoint end = projection.Project(tree.end[row]);
    const double from = projection.Width(tree.radius_start[row]);
    const double to = projection.Width(tree.radius_end[row]);
    // A row that tapers is drawn in pieces, each half a pixel thinner.
    const int pieces = 1 + static_cast<int>(2 * std::fabs(to - from));
    for (int piece = 0; piece < pieces; ++piece) {
      const auto at = [&](int k) {
        const double along = static_cast<double>(k) / pieces;
        return PixelPoint{std::lerp(start.x, end.x, along),
                          std::lerp(start.y, end.y, along)};
      };
      const double width =
          std::lerp(from, to, static_cast<double>(piece) / pieces);
      canvas.DrawLine(at(piece), at(piece + 1),
                      std::max(width, kThinnest * kOversampling), colour);
    }
  }
  return Resized(canvas.picture(), size, size);
}

void SpreadGenerations(core::SegmentBlock* set) {
  const float length = set->end[0].x - set->start[0].x;
  core::GenerationWalk generations(*set);
  for (std::size_t row = 0; row < set->rows(); ++row) {
    const float z =
        -kBarStep * length * static_cast<float>(generations.At(row));
    const float own = set->end[row].x - set->start[row].x;
    const float radius = std::min(kBarRadius * length, kBarRadiusOfOwn * own);
    set->start[row] = {set->start[row].x + radius, 0, z};
    set->end[row] = {set->end[row].x - radius, 0, z};
    set->radius_start[row] = set->radius_end[row] = radius;
  }
}

}  // namespace terrane::client
