// BladeOutline: half the outline of a petal or leaf, as a spline.
//
// A Catmull-Rom curve of tension 0.5 from the base (0, 0) through the sketch's
// points to the tip (0, 1), one span between neighbours. It passes through its
// points; the other half is its mirror image.
//
// Immutable and thread-safe. Double precision; IEEE operations only.
//
// Source: Wang, Zhang & Yang 2019, eqs. 1-3.
#ifndef TERRANE_CORE_FLOWER_BLADE_OUTLINE_H_
#define TERRANE_CORE_FLOWER_BLADE_OUTLINE_H_

#include <array>
#include <cstddef>
#include <string>

#include "core/flower/flower_spec.h"

namespace terrane::core {

inline constexpr std::size_t kLeastSketchPoints = 2;
inline constexpr std::size_t kMostSketchPoints = 3;

class BladeOutline {
 public:
  // The sketch has kLeastSketchPoints to kMostSketchPoints points.
  explicit BladeOutline(const Sketch& sketch);

  // Spans between neighbouring points; the curve's parameter goes from 0 to
  // this.
  int spans() const { return spans_; }
  SketchPoint At(double t) const;

  // The largest half width, and the largest (x / widest)^2 + y^2, of 64 places
  // along the curve.
  double widest() const { return widest_; }
  double farthest() const { return farthest_; }

  // What is wrong with the curve between its points: it falls back or crosses
  // the axis. Empty when nothing is.
  std::string Fault() const;

 private:
  // a + b t + c t^2 + d t^3 on one span.
  struct Cubic {
    double a = 0, b = 0, c = 0, d = 0;
    double At(double t) const { return a + (b + (c + d * t) * t) * t; }
    // The smallest slope, and the smallest value between the two ends.
    double LeastSlope() const;
    double LeastInside() const;
  };
  struct Span {
    Cubic x;
    Cubic y;
  };

  static Cubic Through(double p0, double p1, double p2, double p3);

  std::array<Span, kMostSketchPoints + 1> span_;
  int spans_ = 0;
  double widest_ = 0;
  double farthest_ = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_BLADE_OUTLINE_H_
