// Tables of numbers as CSV: a header line, then one row a line, each number
// with the fewest digits that read back to the same value. Errors name the
// line.
#ifndef TERRANE_CLIENT_CSV_H_
#define TERRANE_CLIENT_CSV_H_

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

// Writes text to a file (client/output_file.h), or to standard output for "-".
absl::Status WriteText(const std::string& path, const std::string& text);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CSV_H_
