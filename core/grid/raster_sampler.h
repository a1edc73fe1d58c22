// Interpolation of a raster of float values, made for whole grids of samples.
//
// A sampler sees width * height values, row-major, post (i, j) at (u, v) = (i,
// j); it knows nothing of the world, so it serves elevation models and
// amplitude maps alike. Samples outside the posts take the nearest border
// position.
//   BILINEAR and CATMULL_ROM meet every post to the bit (only -0 becomes 0);
//   BSPLINE is the interpolating cubic, prefiltered once, and meets the posts
//   to rounding.
// NaN posts are no data: a sample whose nearest post is no data is NaN; for any
// other sample the posts that are missing around it are filled from their
// neighbours.
//
// Immutable and thread-safe. Determinism: a value is a function of its own (u,
// v); weights and sums are double in a fixed order, rounded to float once.
// Cost: one pass of 2 or 4 contiguous rows per row of samples; the passes along
// the rows are shared by all sample rows that need them.
#ifndef TERRANE_CORE_GRID_RASTER_SAMPLER_H_
#define TERRANE_CORE_GRID_RASTER_SAMPLER_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace terrane::core {

enum class SampleKernel { kBilinear, kCatmullRom, kBSpline };

class RasterSampler {
 public:
  // `values` must outlive the sampler: it is only copied when it holds NaN or
  // for kBSpline. Width and height at least 2.
  RasterSampler(std::span<const float> values, std::int64_t width,
                std::int64_t height, SampleKernel kernel);

  // Moving keeps the values where they are; copying would not.
  RasterSampler(const RasterSampler&) = delete;
  RasterSampler& operator=(const RasterSampler&) = delete;
  RasterSampler(RasterSampler&&) = default;
  RasterSampler& operator=(RasterSampler&&) = default;

  // Writes the value at (u[i], v[j]) to out[j * stride + i]. Finite
  // coordinates, in any order; fastest when v is monotonic.
  void Sample(std::span<const double> u, std::span<const double> v, float* out,
              std::ptrdiff_t stride) const;

  // Bounds that no value in [min_u, max_u] x [min_v, max_v] exceeds.
  struct Bounds {
    double minimum = 0;
    double maximum = 0;
  };
  Bounds BoundsIn(double min_u, double min_v, double max_u, double max_v) const;

 private:
  // What one column or row of samples takes from the posts along its axis.
  struct Taps {
    std::uint32_t index[4];
    double weight[4];
    std::uint32_t nearest;
  };

  template <int kTaps>
  void SampleWith(std::span<const double> u, std::span<const double> v,
                  float* out, std::ptrdiff_t stride) const;
  Taps TapsAt(double position, std::int64_t count) const;
  std::uint32_t TapIndex(std::int64_t index, std::int64_t count) const;
  void MaskRow(std::span<const Taps> columns, const Taps& row,
               float* out) const;
  void BuildBlocks();

  std::span<const float> values_;
  std::int64_t width_;
  std::int64_t height_;
  SampleKernel kernel_;
  bool has_no_data_ = false;
  // Filled values or spline coefficients; empty when values_ itself serves.
  std::vector<float> prepared_;
  // What the taps read: prepared_ or values_.
  std::span<const float> source_;
  // Extremes of square blocks of source_, row-major.
  std::int64_t blocks_x_ = 0;
  std::vector<float> block_minimum_;
  std::vector<float> block_maximum_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_RASTER_SAMPLER_H_
