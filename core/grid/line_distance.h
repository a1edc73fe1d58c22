// Distance from samples to a line of segments: an open polyline, or the outline
// of a polygon, whose inside is at distance 0 (even-odd rule).
//
// Norms: L2, and L1, the paper's diamond (Tan & Chen 2003, eq. 13). Distances
// are given squared. On a line (1 dimension) only x counts and the geometry is
// the interval of its x.
//
// Immutable and thread-safe. Determinism: a value is a function of the sample's
// own position; segments are left out only where they cannot be the nearest, so
// that the cost per sample hardly grows with their number.
#ifndef TERRANE_CORE_GRID_LINE_DISTANCE_H_
#define TERRANE_CORE_GRID_LINE_DISTANCE_H_

#include <cstddef>
#include <span>
#include <vector>

#include "core/grid/lattice_window.h"
#include "core/grid/sample_rect.h"

namespace terrane::core {

class LineDistance {
 public:
  enum class Norm { kL1, kL2 };
  enum class Form { kPolyline, kPolygon };

  struct Vertex {
    double x = 0;
    double y = 0;
  };

  // At least 1 vertex; one alone is a point.
  LineDistance(std::span<const Vertex> vertices, Form form, Norm norm,
               int dimensions);

  // Box of the vertices; endless in y on a line.
  const Box& box() const { return box_; }

  // Writes the squared distance of every sample of `rect` to `out`, packed row
  // by row (rect.columns() to a row); infinity where it is above `reach`.
  void Squared(const SampleGrid& grid, const SampleRect& rect, double reach,
               double* out) const;

 private:
  struct Segment {
    double x, y;            // first end
    double dx, dy;          // to the second one
    double end_y;           // of the second one, to the bit
    double inverse_square;  // 1 / (dx^2 + dy^2), 0 for a point
    Box box;
  };
  // A rectangle of samples being filled: `out` is that of `whole`.
  struct Target {
    const SampleGrid& grid;
    const SampleRect& whole;
    double reach_squared;
    double* out;
  };

  static Segment MakeSegment(const Vertex& a, const Vertex& b);
  // Where the rectangle's samples lie, as far as the distance is concerned.
  Box SampleBox(const Target& target, const SampleRect& rect) const;
  template <Norm kNorm>
  static double SquaredTo(const Segment& segment, double x, double y);
  // Lowers the squared distances of a row of samples to that of the segment.
  template <Norm kNorm>
  static void LowerRow(const Segment& segment, std::span<const double> x,
                       double y, double* row);
  double SquaredGap(const Box& segment, const Box& samples) const;
  double SquaredFarthest(const Segment& segment, const Box& samples) const;
  // Fills `rect` from the candidates, splitting it while that leaves out many.
  void Fill(const Target& target, const SampleRect& rect,
            std::span<const Segment> candidates) const;
  // Those of `candidates` that can be the nearest of a sample in `samples`.
  std::vector<Segment> Nearest(const Box& samples, double reach_squared,
                               std::span<const Segment> candidates) const;
  void FillPlainly(const Target& target, const SampleRect& rect,
                   std::span<const Segment> candidates) const;
  void ZeroInside(const Target& target) const;

  Norm norm_;
  Form form_;
  bool ignores_y_;
  std::vector<Segment> segments_;
  Box box_;
  // Larger side of the box: the scale of rounding in a distance.
  double extent_ = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_LINE_DISTANCE_H_
