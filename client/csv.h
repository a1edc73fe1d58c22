// Tables of numbers as CSV: a header line, then one row a line, each number
// with the fewest digits that read back to the same value. Errors name the
// line.
#ifndef TERRANE_CLIENT_CSV_H_
#define TERRANE_CLIENT_CSV_H_

#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace terrane::client {

// Reads rows of at least `columns` numbers, divided by commas; further columns
// are kept when every row has them. A first line that is no number is a header;
// empty lines are passed over. The result is column by column.
absl::StatusOr<std::vector<std::vector<double>>> ReadCsv(
    std::istream* input, const std::string& name, std::size_t columns);

// A column that is looked for by any of its names, whatever their case.
struct CsvColumn {
  std::vector<std::string> names;
  bool required = true;
};

struct CsvTable {
  // One for each column that was looked for; empty when it is not there.
  std::vector<std::vector<double>> columns;
  // The line of each row, from 1.
  std::vector<std::int64_t> lines;
};

// Reads some columns of a file whose first line names them all. Other columns
// may hold any text, in quotes when there is a comma in it; empty lines are
// passed over. Numbers must be finite.
absl::StatusOr<CsvTable> ReadCsvColumns(std::istream* input,
                                        const std::string& name,
                                        const std::vector<CsvColumn>& wanted);

// Writes text to a file (client/output_file.h), or to standard output for "-".
absl::Status WriteText(const std::string& path, const std::string& text);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CSV_H_
