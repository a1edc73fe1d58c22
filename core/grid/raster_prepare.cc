#include "core/grid/raster_prepare.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace terrane::core {
namespace {

double MeanOfData(std::span<const float> values) {
  double sum = 0;
  std::int64_t count = 0;
  for (const float value : values) {
    if (std::isnan(value)) continue;
    sum += static_cast<double>(value);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

// Mean of what is known among the eight neighbours; NaN when nothing is.
float NeighbourMean(std::int64_t width, std::int64_t height, std::int64_t index,
                    std::span<const float> values) {
  const std::int64_t x = index % width;
  const std::int64_t y = index / width;
  double sum = 0;
  int count = 0;
  for (std::int64_t j = y - 1; j <= y + 1; ++j) {
    for (std::int64_t i = x - 1; i <= x + 1; ++i) {
      if (i < 0 || j < 0 || i >= width || j >= height) continue;
      const float value = values[static_cast<std::size_t>(j * width + i)];
      if (std::isnan(value)) continue;
      sum += static_cast<double>(value);
      ++count;
    }
  }
  return count > 0 ? static_cast<float>(sum / count)
                   : std::numeric_limits<float>::quiet_NaN();
}

// The tridiagonal system of the prefilter, eliminated once per axis length.
class CubicPrefilter {
 public:
  explicit CubicPrefilter(std::size_t count) : factors_(count) {
    // Rows: 4 c0 + 2 c1; c[k-1] + 4 c[k] + c[k+1]; 2 c[n-2] + 4 c[n-1]; all = 6
    // s.
    factors_[0] = 2.0 / 4.0;
    for (std::size_t k = 1; k < count; ++k) {
      factors_[k] = 1.0 / (4.0 - Below(k) * factors_[k - 1]);
    }
  }

  // Forward elimination of element k, given the one before.
  double Forward(std::size_t k, double value, double previous) const {
    if (k == 0) return 6.0 * value / 4.0;
    return (6.0 * value - Below(k) * previous) * factors_[k];
  }
  // Back substitution of element k, given the one after.
  double Backward(std::size_t k, double value, double next) const {
    return value - factors_[k] * next;
  }

 private:
  double Below(std::size_t k) const {
    return k + 1 == factors_.size() ? 2.0 : 1.0;
  }

  // Above-diagonal elements after elimination.
  std::vector<double> factors_;
};

void PrefilterRow(const CubicPrefilter& filter, std::span<float> row) {
  double carried = 0;
  for (std::size_t k = 0; k < row.size(); ++k) {
    carried = filter.Forward(k, static_cast<double>(row[k]), carried);
    row[k] = static_cast<float>(carried);
  }
  for (std::size_t k = row.size() - 1; k-- > 0;) {
    carried = filter.Backward(k, static_cast<double>(row[k]), carried);
    row[k] = static_cast<float>(carried);
  }
}

// Along the columns, all of them together: rows are contiguous.
void PrefilterColumns(const CubicPrefilter& filter, std::size_t width,
                      std::size_t height, std::span<float> values) {
  for (std::size_t k = 0; k < height; ++k) {
    float* row = values.data() + k * width;
    const float* previous = k == 0 ? row : row - width;
    for (std::size_t i = 0; i < width; ++i) {
      row[i] = static_cast<float>(filter.Forward(
          k, static_cast<double>(row[i]), static_cast<double>(previous[i])));
    }
  }
  for (std::size_t k = height - 1; k-- > 0;) {
    float* row = values.data() + k * width;
    const float* next = row + width;
    for (std::size_t i = 0; i < width; ++i) {
      row[i] = static_cast<float>(filter.Backward(
          k, static_cast<double>(row[i]), static_cast<double>(next[i])));
    }
  }
}

}  // namespace

void FillNoData(std::int64_t width, std::int64_t height, int rings,
                std::span<float> values) {
  const float mean = static_cast<float>(MeanOfData(values));
  std::vector<std::int64_t> missing;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) missing.push_back(static_cast<std::int64_t>(i));
  }
  std::vector<float> found;
  for (int ring = 0; ring < rings && !missing.empty(); ++ring) {
    // All means of a ring come from the ring before: the order does not matter.
    found.clear();
    for (const std::int64_t index : missing) {
      found.push_back(NeighbourMean(width, height, index, values));
    }
    std::size_t left = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      values[static_cast<std::size_t>(missing[k])] = found[k];
      if (std::isnan(found[k])) missing[left++] = missing[k];
    }
    missing.resize(left);
  }
  for (const std::int64_t index : missing) {
    values[static_cast<std::size_t>(index)] = mean;
  }
}

void PrefilterCubicBSpline(std::int64_t width, std::int64_t height,
                           std::span<float> values) {
  const std::size_t columns = static_cast<std::size_t>(width);
  const std::size_t rows = static_cast<std::size_t>(height);
  const CubicPrefilter along_rows(columns);
  for (std::size_t j = 0; j < rows; ++j) {
    PrefilterRow(along_rows, values.subspan(j * columns, columns));
  }
  PrefilterColumns(CubicPrefilter(rows), columns, rows, values);
}

}  // namespace terrane::core
