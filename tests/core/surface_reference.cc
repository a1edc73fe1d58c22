#include "tests/core/surface_reference.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "gtest/gtest.h"

namespace terrane::core {
namespace {

// All blending functions of an axis at a parameter.
std::vector<double> BlendingFunctions(const Basis& basis, double t) {
  std::array<double, Basis::kMaxCount> values;
  const int first = basis.Values(t, values);
  std::vector<double> all(static_cast<std::size_t>(basis.count()), 0.0);
  for (int k = 0; k < basis.support(); ++k) {
    all[static_cast<std::size_t>(first + k)] =
        values[static_cast<std::size_t>(k)];
  }
  return all;
}

double Dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

// K steps of the LMS rule, as they stand in the textbooks.
void TrainByLms(const std::vector<double>& x, double desired, int steps,
                double learning_rate, std::vector<double>* w) {
  for (int step = 0; step < steps; ++step) {
    const double error = desired - Dot(*w, x);
    for (std::size_t k = 0; k < x.size(); ++k) {
      (*w)[k] += 2 * learning_rate * error * x[k];
    }
  }
}

}  // namespace

ReferenceSample ReferenceAt(const SurfaceSpec& spec, const SurfaceGrid& grid,
                            std::int64_t it, std::int64_t iu, int steps,
                            double learning_rate) {
  const SurfaceModel model(spec);
  const std::vector<double> ft =
      BlendingFunctions(model.along_t, GridParameter(it, grid.columns));
  const std::vector<double> fu =
      BlendingFunctions(model.along_u, GridParameter(iu, grid.rows));
  const bool products = spec.method == SurfaceMethod::kProducts;
  const std::size_t columns = ft.size();
  std::vector<double> x;
  std::vector<double> w;
  for (std::size_t j = 0; j < (products ? fu.size() : 1); ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      x.push_back(products ? ft[i] * fu[j] : ft[i]);
      w.push_back(model.network.Initial(static_cast<int>(i),
                                        static_cast<int>(j), it, iu));
    }
  }
  ReferenceSample sample;
  TrainByLms(x, model.network.Desired(it, iu), steps, learning_rate, &w);
  sample.response = Dot(w, x);
  std::vector<double> wu(fu.size(), 0.0);
  if (HasNetworkU(spec.method)) {
    for (std::size_t j = 0; j < fu.size(); ++j) {
      wu[j] = model.network_u.Initial(static_cast<int>(j), 0, it, iu);
    }
    TrainByLms(fu, model.network_u.Desired(it, iu), steps, learning_rate, &wu);
    sample.response_u = Dot(wu, fu);
  }
  double height = 0;
  for (std::size_t j = 0; j < fu.size(); ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      double weight = 0;
      switch (spec.method) {
        case SurfaceMethod::kProducts:
          weight = w[j * columns + i];
          break;
        case SurfaceMethod::kAlongT:
          weight = w[i];
          break;
        case SurfaceMethod::kTwoFactors:
          weight = w[i] * wu[j];
          break;
        case SurfaceMethod::kTwoTerms:
          weight = w[i] + wu[j];
          break;
      }
      const int ci = static_cast<int>(i);
      const int cj = static_cast<int>(j);
      const double term = ft[i] * fu[j] * weight * model.Height(ci, cj);
      height += term;
      // Weights cancel before they are read out, so each counts for itself.
      sample.scale += std::fabs(ft[i] * fu[j]) * (1 + std::fabs(weight)) *
                      std::fabs(model.Height(ci, cj));
      sample.scale +=
          std::fabs(ft[i] * fu[j]) *
          (std::fabs(model.Flat(ci, cj).x) + std::fabs(model.Flat(ci, cj).y) +
           std::fabs(model.Flat(ci, cj).z));
      sample.position.x += ft[i] * fu[j] * model.Flat(ci, cj).x;
      sample.position.y += ft[i] * fu[j] * model.Flat(ci, cj).y;
      sample.position.z += ft[i] * fu[j] * model.Flat(ci, cj).z;
    }
  }
  sample.position.x += height * model.direction.x;
  sample.position.y += height * model.direction.y;
  sample.position.z += height * model.direction.z;
  return sample;
}

PointNet HillNet() {
  constexpr double kHeights[4][4] = {{0, 0.4, 0.4, 0},
                                     {0.4, 2.4, 2, 0.3},
                                     {0.5, 2, 1.6, 0.4},
                                     {0, 0.3, 0.4, 0}};
  PointNet net;
  net.basis = SplineBasis::kBezier;
  net.columns = 4;
  net.rows = 4;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      net.points.push_back({1.0 * i, 1.0 * j, kHeights[j][i]});
    }
  }
  return net;
}

PointNet WavyNet(SplineBasis basis, int degree, int columns, int rows) {
  PointNet net;
  net.basis = basis;
  net.degree = degree;
  net.columns = columns;
  net.rows = rows;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      net.points.push_back(
          {1.0 * i, 1.0 * j,
           3 + std::sin(1.7 * i) + std::cos(2.3 * j + 0.4 * i)});
    }
  }
  return net;
}

std::vector<float> PositionsOf(const Surface& surface,
                               const SurfaceRequest& request) {
  std::vector<float> positions(static_cast<std::size_t>(
      3 * request.window.width * request.window.height));
  const absl::Status status =
      surface.Generate(request, {}, {positions, {}, {}});
  EXPECT_TRUE(status.ok()) << status;
  return positions;
}

std::vector<float> HeightsOf(const Surface& surface,
                             const SurfaceRequest& request) {
  std::vector<float> heights(
      static_cast<std::size_t>(request.window.width * request.window.height));
  const absl::Status status = surface.GenerateHeights(request, {}, heights);
  EXPECT_TRUE(status.ok()) << status;
  return heights;
}

std::vector<float> HeightsOf(const SurfaceSpec& spec, const SurfaceGrid& grid) {
  const auto surface = Surface::Create(spec);
  EXPECT_TRUE(surface.ok()) << surface.status();
  return HeightsOf(**surface, {grid, {0, 0, grid.columns, grid.rows}});
}

std::vector<float> RegularHeightsOf(const SurfaceSpec& spec,
                                    const SurfaceGrid& grid) {
  const auto surface = Surface::Create(spec);
  EXPECT_TRUE(surface.ok()) << surface.status();
  std::vector<float> positions(
      static_cast<std::size_t>(3 * grid.columns * grid.rows));
  const absl::Status status = (*surface)->GenerateRegular(
      {grid, {0, 0, grid.columns, grid.rows}}, {}, {positions, {}, {}});
  EXPECT_TRUE(status.ok()) << status;
  std::vector<float> heights;
  for (std::size_t k = 2; k < positions.size(); k += 3) {
    heights.push_back(positions[k]);
  }
  return heights;
}

}  // namespace terrane::core
