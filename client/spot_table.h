// SpotTable: spot heights in memory, column by column.
#ifndef TERRANE_CLIENT_SPOT_TABLE_H_
#define TERRANE_CLIENT_SPOT_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrane::client {

// Columns of equal length. standard_error is empty when every height is exact.
struct SpotTable {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> height;
  std::vector<double> standard_error;
  // Where each row stands in its file: the line of a CSV, the feature of a
  // layer.
  std::vector<std::int64_t> source;

  std::size_t rows() const { return x.size(); }
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SPOT_TABLE_H_
