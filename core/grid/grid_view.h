// Grids of floats for the hot loops: views and the memory behind them.
#ifndef TERRANE_CORE_GRID_GRID_VIEW_H_
#define TERRANE_CORE_GRID_GRID_VIEW_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrane::core {

// Floats behind the last column of a row that kernels may read and write: two
// vectors of 64 bytes (interleaved stores), and the reach of a stencil. What
// stands there is meaningless.
inline constexpr std::ptrdiff_t kRowSlack = 2 * 16 + 8;

// A grid of floats that somebody else owns: (i, j) at data[j * stride + i].
struct GridView {
  float* data = nullptr;
  std::ptrdiff_t stride = 0;

  float* Row(std::ptrdiff_t j) const { return data + j * stride; }
  float& At(std::ptrdiff_t i, std::ptrdiff_t j) const {
    return data[j * stride + i];
  }
};

// Memory for one grid, used again and again: grows, never shrinks.
class GridBuffer {
 public:
  // A grid of that many columns and rows with kRowSlack behind every row. Its
  // contents are left over from before.
  GridView Shape(std::int64_t columns, std::int64_t rows) {
    const std::ptrdiff_t stride = (columns + kRowSlack + 15) / 16 * 16;
    const auto size = static_cast<std::size_t>(stride * rows);
    if (storage_.size() < size) storage_.resize(size);
    return {storage_.data(), stride};
  }

 private:
  std::vector<float> storage_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_GRID_VIEW_H_
