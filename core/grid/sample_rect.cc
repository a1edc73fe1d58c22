#include "core/grid/sample_rect.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace terrane::core {
namespace {

// First and one past the last index whose coordinate lies in [low, high].
std::pair<std::size_t, std::size_t> IndicesIn(const std::vector<double>& axis,
                                              double low, double high) {
  const bool rising = axis.empty() || axis.front() <= axis.back();
  const auto before = [=](double at) { return rising ? at < low : at > high; };
  const auto within = [=](double at) {
    return rising ? at <= high : at >= low;
  };
  const auto begin = std::partition_point(axis.begin(), axis.end(), before);
  const auto end = std::partition_point(begin, axis.end(), within);
  return {static_cast<std::size_t>(begin - axis.begin()),
          static_cast<std::size_t>(end - axis.begin())};
}

}  // namespace

SampleRect Intersection(const SampleRect& a, const SampleRect& b) {
  return {std::max(a.column_begin, b.column_begin),
          std::min(a.column_end, b.column_end),
          std::max(a.row_begin, b.row_begin), std::min(a.row_end, b.row_end)};
}

SampleRect AllSamples(const SampleGrid& grid) {
  return {0, grid.x.size(), 0, grid.y.size()};
}

Box BoxOf(const SampleGrid& grid, const SampleRect& rect) {
  const auto [min_x, max_x] =
      std::minmax(grid.x[rect.column_begin], grid.x[rect.column_end - 1]);
  const auto [min_y, max_y] =
      std::minmax(grid.y[rect.row_begin], grid.y[rect.row_end - 1]);
  return {min_x, min_y, max_x, max_y};
}

SampleRect SamplesIn(const SampleGrid& grid, const Box& box) {
  const auto [column_begin, column_end] =
      IndicesIn(grid.x, box.min_x, box.max_x);
  const auto [row_begin, row_end] = IndicesIn(grid.y, box.min_y, box.max_y);
  return {column_begin, column_end, row_begin, row_end};
}

}  // namespace terrane::core
