// Columns of a block held against the bytes that they must have and against
// their checksum. Pure functions.
#ifndef TERRANE_CLIENT_COLUMN_CHECK_H_
#define TERRANE_CLIENT_COLUMN_CHECK_H_

#include <cstdint>
#include <initializer_list>
#include <string>

#include "absl/status/status.h"

namespace terrane::client {

// A column and the bytes that it must have.
struct Column {
  const char* name;
  const std::string& bytes;
  std::int64_t expected;
};

// DATA_LOSS: "rows from 256: ...".
absl::Status WrongBlock(const std::string& block, const std::string& what);

absl::Status CheckColumns(const std::string& block,
                          std::initializer_list<Column> columns,
                          std::uint64_t checksum);

// Whether a block came where it belongs.
absl::Status CheckPlace(const std::string& block, std::int64_t came,
                        std::int64_t expected);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COLUMN_CHECK_H_
