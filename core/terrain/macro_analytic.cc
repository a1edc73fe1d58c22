#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/det_math.h"
#include "core/grid/line_distance.h"
#include "core/terrain/macro_part.h"

namespace terrane::core {
namespace {

// Standard deviations from the centre of a Gaussian hill to where it ends:
// exp(-12^2 / 2) = 5e-32 of its height is far below a float's rounding.
constexpr double kHillReach = 12.0;

// A box around `centre`, endless in y on a line.
Box BoxAround(const Point2& centre, double reach_x, double reach_y,
              int dimensions) {
  Box box{centre.x - reach_x, centre.y - reach_y, centre.x + reach_x,
          centre.y + reach_y};
  if (dimensions == 1) {
    box.min_y = kEverywhere.min_y;
    box.max_y = kEverywhere.max_y;
  }
  return box;
}

// A shape between 0 and `height`, 0 outside `support`.
class BoundedPart : public MacroShapePart {
 public:
  BoundedPart(const Box& support, double height)
      : support_(support), height_(height) {}

  Box Support() const override { return support_; }

  MacroShape::Bounds BoundsIn(const Box& box) const override {
    if (!support_.Intersects(box)) return {0, 0};
    return {std::min(0.0, height_), std::max(0.0, height_)};
  }

 protected:
  double height() const { return height_; }

 private:
  Box support_;
  double height_;
};

class PlanePart : public MacroShapePart {
 public:
  PlanePart(const Plane& plane, int dimensions) : plane_(plane) {
    if (dimensions == 1) plane_.slope_y = 0;
  }

  void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                double* out) const override {
    for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
      for (std::size_t i = rect.column_begin; i < rect.column_end; ++i) {
        *out++ = HeightAt(grid.x[i], grid.y[j]);
      }
    }
  }

  MacroShape::Bounds BoundsIn(const Box& box) const override {
    // Extremes of a plane are at corners; the formula rounds monotonically.
    const bool up_x = plane_.slope_x >= 0;
    const bool up_y = plane_.slope_y >= 0;
    return {
        HeightAt(up_x ? box.min_x : box.max_x, up_y ? box.min_y : box.max_y),
        HeightAt(up_x ? box.max_x : box.min_x, up_y ? box.max_y : box.min_y)};
  }

 private:
  double HeightAt(double x, double y) const {
    return plane_.height + Rise(plane_.slope_x, x - plane_.point.x) +
           Rise(plane_.slope_y, y - plane_.point.y);
  }
  // A level axis rises by 0 even over an endless distance.
  static double Rise(double slope, double distance) {
    return slope == 0 ? 0.0 : slope * distance;
  }

  Plane plane_;
};

class ConePart : public BoundedPart {
 public:
  ConePart(const Cone& cone, int dimensions)
      : BoundedPart(
            BoxAround(cone.centre, cone.radius, cone.radius, dimensions),
            cone.height),
        cone_(cone),
        dimensions_(dimensions) {}

  void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                double* out) const override {
    for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
      const double dy = dimensions_ == 1 ? 0.0 : grid.y[j] - cone_.centre.y;
      for (std::size_t i = rect.column_begin; i < rect.column_end; ++i) {
        const double dx = grid.x[i] - cone_.centre.x;
        const double r = std::sqrt(dx * dx + dy * dy);
        *out++ = height() * std::max(0.0, 1.0 - r / cone_.radius);
      }
    }
  }

 private:
  Cone cone_;
  int dimensions_;
};

class GaussianHillPart : public BoundedPart {
 public:
  GaussianHillPart(const GaussianHill& hill, double sigma_y, int dimensions)
      : BoundedPart(BoxAround(hill.centre, kHillReach * hill.sigma_x,
                              kHillReach * sigma_y, dimensions),
                    hill.height),
        centre_(hill.centre),
        sigma_x_(hill.sigma_x),
        sigma_y_(sigma_y),
        dimensions_(dimensions) {}

  void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                double* out) const override {
    // exp(-(a + b)) = exp(-a) exp(-b): one exponential a column and a row.
    std::vector<double> along_x;
    along_x.reserve(rect.columns());
    for (std::size_t i = rect.column_begin; i < rect.column_end; ++i) {
      along_x.push_back(Bell((grid.x[i] - centre_.x) / sigma_x_));
    }
    for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
      const double along_y =
          dimensions_ == 1 ? 1.0 : Bell((grid.y[j] - centre_.y) / sigma_y_);
      for (const double bell : along_x) *out++ = height() * (bell * along_y);
    }
  }

 private:
  static double Bell(double t) { return DetExp(-0.5 * t * t); }

  Point2 centre_;
  double sigma_x_;
  double sigma_y_;
  int dimensions_;
};

std::vector<LineDistance::Vertex> Vertices(const std::vector<Point2>& points) {
  std::vector<LineDistance::Vertex> vertices;
  vertices.reserve(points.size());
  for (const Point2& point : points) vertices.push_back({point.x, point.y});
  return vertices;
}

// A shape that falls from `height` on a line or in a polygon to 0 at a distance
// of `width`.
class FlankedPart : public BoundedPart {
 public:
  enum class Profile { kLinear, kSmooth };

  FlankedPart(LineDistance distance, double width, double height,
              Profile profile)
      : BoundedPart(distance.box().Grown(width), height),
        distance_(std::move(distance)),
        width_(width),
        profile_(profile) {}

  void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                double* out) const override {
    distance_.Squared(grid, rect, width_, out);
    const std::size_t count = rect.columns() * rect.rows();
    for (std::size_t i = 0; i < count; ++i) out[i] = height() * Share(out[i]);
  }

 private:
  // Share of the height at a squared distance; infinity is beyond the width.
  double Share(double squared_distance) const {
    if (squared_distance == 0) return 1.0;
    if (squared_distance == std::numeric_limits<double>::infinity()) return 0.0;
    const double t = std::max(0.0, 1.0 - std::sqrt(squared_distance) / width_);
    return profile_ == Profile::kLinear ? t : t * t * (3.0 - 2.0 * t);
  }

  LineDistance distance_;
  double width_;
  Profile profile_;
};

}  // namespace

std::unique_ptr<MacroShapePart> MakePart(const Plane& plane, int dimensions) {
  return std::make_unique<PlanePart>(plane, dimensions);
}

std::unique_ptr<MacroShapePart> MakePart(const Cone& cone, int dimensions) {
  return std::make_unique<ConePart>(cone, dimensions);
}

std::unique_ptr<MacroShapePart> MakePart(const GaussianHill& hill,
                                         int dimensions) {
  const double sigma_y = hill.sigma_y != 0 ? hill.sigma_y : hill.sigma_x;
  return std::make_unique<GaussianHillPart>(hill, sigma_y, dimensions);
}

std::unique_ptr<MacroShapePart> MakePart(const Ridge& ridge, int dimensions) {
  return std::make_unique<FlankedPart>(
      LineDistance(Vertices(ridge.crest), LineDistance::Form::kPolyline,
                   LineDistance::Norm::kL2, dimensions),
      ridge.half_width, ridge.height, FlankedPart::Profile::kSmooth);
}

std::unique_ptr<MacroShapePart> MakePart(const Boss& boss, int dimensions) {
  return std::make_unique<FlankedPart>(
      LineDistance(Vertices(boss.outline), LineDistance::Form::kPolygon,
                   LineDistance::Norm::kL2, dimensions),
      boss.flank_width, boss.height, FlankedPart::Profile::kLinear);
}

}  // namespace terrane::core
