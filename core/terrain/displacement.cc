#include "core/terrain/displacement.h"

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/base/det_math.h"

namespace terrane::core {
namespace {

// Deslauriers-Dubuc weights of the four points at -1.5, -0.5, 0.5, 1.5.
constexpr std::array<double, 4> kWeights = {-1.0 / 16, 9.0 / 16, 9.0 / 16,
                                            -1.0 / 16};

// The prediction error is a weighted sum of variogram values: the weights, by
// squared distance. (Few distances occur, so the error is cheap for many H.)
using WeightByDistance = std::map<double, double>;

WeightByDistance StencilWeights(int dimensions) {
  struct Point {
    double x, y, weight;
  };
  std::vector<Point> points;
  for (std::size_t a = 0; a < 4; ++a) {
    const double x = static_cast<double>(a) - 1.5;
    if (dimensions == 1) {
      points.push_back({x, 0, kWeights[a]});
      continue;
    }
    for (std::size_t b = 0; b < 4; ++b) {
      points.push_back(
          {x, static_cast<double>(b) - 1.5, kWeights[a] * kWeights[b]});
    }
  }
  WeightByDistance weights;
  for (const Point& p : points) {
    weights[p.x * p.x + p.y * p.y] += 2 * p.weight;
    for (const Point& q : points) {
      const double dx = p.x - q.x;
      const double dy = p.y - q.y;
      weights[dx * dx + dy * dy] -= p.weight * q.weight;
    }
  }
  return weights;
}

}  // namespace

double SubdivisionPredictionError(double roughness, int dimensions) {
  static const WeightByDistance line = StencilWeights(1);
  static const WeightByDistance plane = StencilWeights(2);
  double error = 0;
  for (const auto& [squared_distance, weight] :
       dimensions == 1 ? line : plane) {
    error += weight * 0.5 * DetPow(squared_distance, roughness);
  }
  return error;
}

double Level0Deviation(FractalSource source) {
  return source == FractalSource::kSubdivision ? std::sqrt(0.5) : 1.0;
}

double DisplacementDeviation(FractalSource source, int dimensions,
                             double roughness, int level, HalfStep step) {
  const bool half = dimensions == 2 && step == HalfStep::kCentre;
  if (source == FractalSource::kSubdivision) {
    // The first displacement of a level spans the spacing of the level before;
    // the edge step is a lattice turned by 45 degrees, finer by sqrt(2).
    const double finer = dimensions == 2 && !half ? 0.5 : 0.0;
    const double error = SubdivisionPredictionError(roughness, dimensions);
    return std::sqrt(error) * DetExp2(-roughness * (level - 1 + finer));
  }
  const double n = half ? level - 0.5 : level;
  return std::sqrt(1 - DetExp2(2 * roughness - 2)) * DetExp2(-roughness * n);
}

}  // namespace terrane::core
