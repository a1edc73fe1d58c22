#include "core/terrain/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "core/base/det_math.h"
#include "core/base/violations.h"
#include "core/grid/raster_prepare.h"
#include "core/grid/raster_sampler.h"
#include "core/terrain/displacement.h"

namespace terrane::core {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr char kField[] = "macro.parts[0].raster";

constexpr std::int64_t kLeastPosts = 8;
// The stencil reaches three posts to both sides, here of every second post.
constexpr std::int64_t kLeastPostsForRoughness = 13;
constexpr double kLeastRoughness = 0.5;
constexpr double kMostRoughness = 0.95;

// Half the side of the box that the local mean square is taken over.
constexpr std::int64_t kBoxRadius = 3;
// Residuals that have no data near them get the value of those that have, this
// far; nothing is generated where the model has no data.
constexpr int kFillRings = 4;

// Deslauriers-Dubuc weights of the posts at -3, -1, 1 and 3.
constexpr std::array<double, 4> kWeights{-1.0 / 16, 9.0 / 16, 9.0 / 16,
                                         -1.0 / 16};

struct FloatGrid {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<float> values;

  const float* Row(std::int64_t j) const { return values.data() + j * width; }
};

// Number of odd posts o among `posts` whose neighbours o - 3 .. o + 3 all
// exist.
std::int64_t InnerOddPosts(std::int64_t posts) {
  return posts >= 7 ? (posts - 5) / 2 : 0;
}

// What is left of the post (i, j) after its prediction from the posts at
// distances of 1 and 3 strides along both axes; NaN when one of them is.
double ResidualAt(const Raster& model, std::int64_t stride, std::int64_t i,
                  std::int64_t j) {
  double prediction = 0;
  for (std::size_t b = 0; b < kWeights.size(); ++b) {
    const std::int64_t row =
        j + (2 * static_cast<std::int64_t>(b) - 3) * stride;
    double along_row = 0;
    for (std::size_t a = 0; a < kWeights.size(); ++a) {
      const std::int64_t column =
          i + (2 * static_cast<std::int64_t>(a) - 3) * stride;
      along_row += kWeights[a] * static_cast<double>(model.At(column, row));
    }
    prediction += kWeights[b] * along_row;
  }
  return static_cast<double>(model.At(i, j)) - prediction;
}

// Residuals of the inner odd-odd posts, in the model that keeps every stride-th
// post: element (a, b) belongs to post ((2 a + 3) stride, (2 b + 3) stride).
FloatGrid Residuals(const Raster& model, std::int64_t stride) {
  FloatGrid residuals;
  residuals.width = InnerOddPosts((model.width - 1) / stride + 1);
  residuals.height = InnerOddPosts((model.height - 1) / stride + 1);
  residuals.values.reserve(
      static_cast<std::size_t>(residuals.width * residuals.height));
  for (std::int64_t b = 0; b < residuals.height; ++b) {
    for (std::int64_t a = 0; a < residuals.width; ++a) {
      residuals.values.push_back(static_cast<float>(ResidualAt(
          model, stride, (2 * a + 3) * stride, (2 * b + 3) * stride)));
    }
  }
  return residuals;
}

// A sum of squares and how many there were.
struct SquareSum {
  double squares = 0;
  double count = 0;

  void Add(float value) {
    if (std::isnan(value)) return;
    squares += static_cast<double>(value) * static_cast<double>(value);
    count += 1;
  }
  void Add(const SquareSum& other) {
    squares += other.squares;
    count += other.count;
  }
};

SquareSum SquareSumOf(const std::vector<float>& values) {
  SquareSum sum;
  for (const float value : values) sum.Add(value);
  return sum;
}

// Mean square of the values in a box around each; NaN where there are none.
FloatGrid BoxMeanSquare(const FloatGrid& grid) {
  FloatGrid result{grid.width, grid.height, {}};
  result.values.reserve(grid.values.size());
  std::vector<SquareSum> columns;
  for (std::int64_t j = 0; j < grid.height; ++j) {
    columns.assign(static_cast<std::size_t>(grid.width), SquareSum{});
    const std::int64_t last_row = std::min(j + kBoxRadius, grid.height - 1);
    for (std::int64_t k = std::max<std::int64_t>(j - kBoxRadius, 0);
         k <= last_row; ++k) {
      const float* row = grid.Row(k);
      for (std::size_t i = 0; i < columns.size(); ++i) columns[i].Add(row[i]);
    }
    for (std::int64_t i = 0; i < grid.width; ++i) {
      SquareSum box;
      const std::int64_t last = std::min(i + kBoxRadius, grid.width - 1);
      for (std::int64_t k = std::max<std::int64_t>(i - kBoxRadius, 0);
           k <= last; ++k) {
        box.Add(columns[static_cast<std::size_t>(k)]);
      }
      result.values.push_back(
          box.count > 0 ? static_cast<float>(box.squares / box.count) : kNone);
    }
  }
  return result;
}

// Blends each value with its neighbours, 1 : 2 : 1 along both axes.
FloatGrid Smoothed(const FloatGrid& grid) {
  FloatGrid result{grid.width, grid.height, {}};
  result.values.reserve(grid.values.size());
  for (std::int64_t j = 0; j < grid.height; ++j) {
    const float* above = grid.Row(std::max<std::int64_t>(j - 1, 0));
    const float* here = grid.Row(j);
    const float* below = grid.Row(std::min(j + 1, grid.height - 1));
    const auto column = [&](std::int64_t i) {
      const std::int64_t k = std::clamp(i, std::int64_t{0}, grid.width - 1);
      return static_cast<double>(above[k]) +
             2.0 * static_cast<double>(here[k]) + static_cast<double>(below[k]);
    };
    for (std::int64_t i = 0; i < grid.width; ++i) {
      result.values.push_back(static_cast<float>(
          (column(i - 1) + 2.0 * column(i) + column(i + 1)) / 16.0));
    }
  }
  return result;
}

// The residual's local root mean square at every post of the model.
std::vector<float> LocalDeviation(const Raster& model,
                                  const FloatGrid& residuals) {
  FloatGrid local = BoxMeanSquare(residuals);
  FillNoData(local.width, local.height, kFillRings, local.values);
  local = Smoothed(local);
  for (float& value : local.values) value = std::sqrt(value);

  // A sampler needs two values along an axis; a map of one is a constant.
  const auto positions = [](std::int64_t posts, std::int64_t values) {
    std::vector<double> result;
    for (std::int64_t i = 0; i < posts; ++i) {
      result.push_back(values > 1 ? 0.5 * static_cast<double>(i - 3) : 0.0);
    }
    return result;
  };
  FloatGrid map{std::max<std::int64_t>(local.width, 2),
                std::max<std::int64_t>(local.height, 2),
                {}};
  for (std::int64_t j = 0; j < map.height; ++j) {
    const float* row = local.Row(std::min(j, local.height - 1));
    for (std::int64_t i = 0; i < map.width; ++i) {
      map.values.push_back(row[std::min(i, local.width - 1)]);
    }
  }
  std::vector<float> deviation(model.values.size());
  RasterSampler(map.values, map.width, map.height, SampleKernel::kBilinear)
      .Sample(positions(model.width, local.width),
              positions(model.height, local.height), deviation.data(),
              model.width);
  return deviation;
}

// Scales the map so that its root mean square over the posts with data is 1; a
// map of zeros stays.
void Normalise(const Raster& model, std::vector<float>* map) {
  SquareSum sum;
  for (std::size_t i = 0; i < map->size(); ++i) {
    if (!std::isnan(model.values[i])) sum.Add((*map)[i]);
  }
  if (sum.squares == 0) return;
  const double scale = 1.0 / std::sqrt(sum.squares / sum.count);
  for (float& value : *map) {
    value = static_cast<float>(static_cast<double>(value) * scale);
  }
}

absl::Status TooFewPosts(const Raster& model, std::int64_t least,
                         const std::string& why) {
  const std::string side = std::to_string(least);
  return ViolationError(kField, "must have at least " + side + " x " + side +
                                    " posts " + why + ", got " +
                                    std::to_string(model.width) + " x " +
                                    std::to_string(model.height));
}

// H from the residual's mean square on every post and on every second one,
// whose ratio is 2^(2H). A model that its even posts predict without any
// residual is as smooth as can be: 1.
absl::StatusOr<double> MeasureRoughness(const Raster& model,
                                        const SquareSum& fine) {
  if (std::min(model.width, model.height) < kLeastPostsForRoughness) {
    return TooFewPosts(model, kLeastPostsForRoughness,
                       "to measure roughness on (or set roughness)");
  }
  const SquareSum coarse = SquareSumOf(Residuals(model, 2).values);
  if (coarse.count == 0) {
    return ViolationError(kField,
                          "has too little data to measure roughness on (or set "
                          "roughness)");
  }
  if (fine.squares == 0 && coarse.squares == 0) return 1.0;
  return 0.5 * (DetLog2(coarse.squares / coarse.count) -
                DetLog2(fine.squares / fine.count));
}

}  // namespace

absl::StatusOr<Calibration> CalibrateRefinement(
    const Raster& model, std::optional<double> roughness) {
  if (std::min(model.width, model.height) < kLeastPosts) {
    return TooFewPosts(model, kLeastPosts, "to calibrate a refinement");
  }
  const FloatGrid residuals = Residuals(model, 1);
  const SquareSum sum = SquareSumOf(residuals.values);
  if (sum.count == 0) {
    return ViolationError(kField,
                          "has no 7 x 7 posts with data to calibrate a "
                          "refinement on");
  }
  Calibration calibration;
  const absl::StatusOr<double> measured = MeasureRoughness(model, sum);
  if (measured.ok()) {
    calibration.measured_roughness = *measured;
  } else if (!roughness.has_value()) {
    return measured.status();
  } else {
    calibration.measured_roughness = std::numeric_limits<double>::quiet_NaN();
  }
  calibration.roughness = roughness.value_or(std::clamp(
      calibration.measured_roughness, kLeastRoughness, kMostRoughness));
  calibration.residual_rms = std::sqrt(sum.squares / sum.count);
  calibration.fidelity = sum.squares / sum.count *
                         DetExp2(-2.0 * calibration.roughness) /
                         SubdivisionPredictionError(calibration.roughness, 2);
  calibration.amplitude = LocalDeviation(model, residuals);
  Normalise(model, &calibration.amplitude);
  return calibration;
}

}  // namespace terrane::core
