#include "core/grid/raster_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grid/cubic_weights.h"
#include "core/grid/raster_prepare.h"

namespace terrane::core {
namespace {

constexpr std::int64_t kBlock = 32;

// A cubic kernel reaches two posts from the nearest one; the prefilter's memory
// fades by 0.27 per post, to nothing in float over this many.
constexpr int kLocalRings = 3;
constexpr int kPrefilterRings = 16;

template <int kTaps, typename Taps>
void InterpolateRow(const float* posts, std::span<const Taps> columns,
                    double* out) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Taps& taps = columns[i];
    double sum = taps.weight[0] * static_cast<double>(posts[taps.index[0]]);
    for (int k = 1; k < kTaps; ++k) {
      sum += taps.weight[k] * static_cast<double>(posts[taps.index[k]]);
    }
    out[i] = sum;
  }
}

template <int kTaps>
void BlendRows(const std::array<const double*, 4>& rows, const double* weight,
               std::size_t count, float* out) {
  for (std::size_t i = 0; i < count; ++i) {
    double sum = weight[0] * rows[0][i];
    for (std::size_t k = 1; k < kTaps; ++k) sum += weight[k] * rows[k][i];
    out[i] = static_cast<float>(sum);
  }
}

}  // namespace

RasterSampler::RasterSampler(std::span<const float> values, std::int64_t width,
                             std::int64_t height, SampleKernel kernel)
    : values_(values),
      width_(width),
      height_(height),
      kernel_(kernel),
      source_(values) {
  has_no_data_ = std::any_of(values.begin(), values.end(),
                             [](float value) { return std::isnan(value); });
  if (has_no_data_ || kernel == SampleKernel::kBSpline) {
    prepared_.assign(values.begin(), values.end());
    source_ = prepared_;
  }
  if (has_no_data_) {
    FillNoData(width, height,
               kernel == SampleKernel::kBSpline ? kPrefilterRings : kLocalRings,
               prepared_);
  }
  if (kernel == SampleKernel::kBSpline) {
    PrefilterCubicBSpline(width, height, prepared_);
  }
  BuildBlocks();
}

void RasterSampler::Sample(std::span<const double> u, std::span<const double> v,
                           float* out, std::ptrdiff_t stride) const {
  if (kernel_ == SampleKernel::kBilinear) {
    SampleWith<2>(u, v, out, stride);
  } else {
    SampleWith<4>(u, v, out, stride);
  }
}

template <int kTaps>
void RasterSampler::SampleWith(std::span<const double> u,
                               std::span<const double> v, float* out,
                               std::ptrdiff_t stride) const {
  std::vector<Taps> columns;
  columns.reserve(u.size());
  for (const double at : u) columns.push_back(TapsAt(at, width_));

  // Rows of posts, interpolated at the columns: the last four that were needed.
  // The taps of a row lie within four neighbouring rows, so none evicts
  // another.
  std::vector<double> lines(4 * u.size());
  std::array<std::int64_t, 4> line_of{-1, -1, -1, -1};
  std::array<const double*, 4> rows{};
  for (std::size_t j = 0; j < v.size(); ++j) {
    const Taps taps = TapsAt(v[j], height_);
    for (std::size_t k = 0; k < kTaps; ++k) {
      const std::uint32_t row = taps.index[k];
      double* line = lines.data() + (row % 4) * u.size();
      if (line_of[row % 4] != row) {
        InterpolateRow<kTaps, Taps>(
            source_.data() + static_cast<std::int64_t>(row) * width_, columns,
            line);
        line_of[row % 4] = row;
      }
      rows[k] = line;
    }
    float* row_out = out + static_cast<std::ptrdiff_t>(j) * stride;
    BlendRows<kTaps>(rows, taps.weight, u.size(), row_out);
    if (has_no_data_) MaskRow(columns, taps, row_out);
  }
}

RasterSampler::Taps RasterSampler::TapsAt(double position,
                                          std::int64_t count) const {
  const double cut = std::clamp(position, 0.0, static_cast<double>(count - 1));
  // The last post is the far end of the last cell.
  const std::int64_t cell = std::min(static_cast<std::int64_t>(cut), count - 2);
  const double t = cut - static_cast<double>(cell);
  Taps taps{};
  taps.nearest = static_cast<std::uint32_t>(cell + (t >= 0.5 ? 1 : 0));
  if (kernel_ == SampleKernel::kBilinear) {
    taps.index[0] = static_cast<std::uint32_t>(cell);
    taps.index[1] = static_cast<std::uint32_t>(cell + 1);
    taps.weight[0] = 1.0 - t;
    taps.weight[1] = t;
    return taps;
  }
  const CubicWeights weights = kernel_ == SampleKernel::kCatmullRom
                                   ? CatmullRomWeights(t)
                                   : BSplineWeights(t);
  for (int k = 0; k < 4; ++k) {
    taps.index[k] = TapIndex(cell + k - 1, count);
    taps.weight[k] = weights.at[k];
  }
  return taps;
}

std::uint32_t RasterSampler::TapIndex(std::int64_t index,
                                      std::int64_t count) const {
  if (kernel_ == SampleKernel::kBSpline) {
    // Mirrored, as the prefilter has it.
    if (index < 0) return static_cast<std::uint32_t>(-index);
    if (index >= count) {
      return static_cast<std::uint32_t>(2 * (count - 1) - index);
    }
  }
  return static_cast<std::uint32_t>(
      std::clamp(index, std::int64_t{0}, count - 1));
}

void RasterSampler::MaskRow(std::span<const Taps> columns, const Taps& row,
                            float* out) const {
  const float* posts =
      values_.data() + static_cast<std::int64_t>(row.nearest) * width_;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (std::isnan(posts[columns[i].nearest])) {
      out[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

void RasterSampler::BuildBlocks() {
  blocks_x_ = (width_ + kBlock - 1) / kBlock;
  const std::int64_t blocks_y = (height_ + kBlock - 1) / kBlock;
  const std::size_t blocks = static_cast<std::size_t>(blocks_x_ * blocks_y);
  block_minimum_.assign(blocks, std::numeric_limits<float>::infinity());
  block_maximum_.assign(blocks, -std::numeric_limits<float>::infinity());
  for (std::int64_t j = 0; j < height_; ++j) {
    for (std::int64_t i = 0; i < width_; ++i) {
      const float value = source_[static_cast<std::size_t>(j * width_ + i)];
      const std::size_t block =
          static_cast<std::size_t>(j / kBlock * blocks_x_ + i / kBlock);
      block_minimum_[block] = std::min(block_minimum_[block], value);
      block_maximum_[block] = std::max(block_maximum_[block], value);
    }
  }
}

RasterSampler::Bounds RasterSampler::BoundsIn(double min_u, double min_v,
                                              double max_u,
                                              double max_v) const {
  const auto post = [](double at, std::int64_t reach, std::int64_t count) {
    const double last = static_cast<double>(count - 1);
    const std::int64_t near =
        static_cast<std::int64_t>(std::clamp(at, 0.0, last));
    return std::clamp(near + reach, std::int64_t{0}, count - 1) / kBlock;
  };
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -minimum;
  const std::int64_t last_i = post(max_u, 2, width_);
  const std::int64_t last_j = post(max_v, 2, height_);
  for (std::int64_t j = post(min_v, -2, height_); j <= last_j; ++j) {
    for (std::int64_t i = post(min_u, -2, width_); i <= last_i; ++i) {
      const std::size_t block = static_cast<std::size_t>(j * blocks_x_ + i);
      minimum = std::min(minimum, static_cast<double>(block_minimum_[block]));
      maximum = std::max(maximum, static_cast<double>(block_maximum_[block]));
    }
  }
  const double gain = kernel_ == SampleKernel::kCatmullRom
                          ? kCatmullRomGain * kCatmullRomGain
                          : 1.0;
  // Room for the rounding of weights, sums and the result.
  const double slack = 1e-6 * std::max(std::fabs(minimum), std::fabs(maximum));
  const double centre = 0.5 * (minimum + maximum);
  const double half = 0.5 * (maximum - minimum) * gain + slack;
  return {centre - half, centre + half};
}

}  // namespace terrane::core
