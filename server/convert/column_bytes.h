// Columns of numbers as the bytes fields of a message, and their checksum.
//
// The API's numbers are little-endian, and so is every machine that this is
// built for. Threads: pure functions.
#ifndef TERRANE_SERVER_CONVERT_COLUMN_BYTES_H_
#define TERRANE_SERVER_CONVERT_COLUMN_BYTES_H_

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <vector>

namespace terrane::server {

static_assert(std::endian::native == std::endian::little,
              "columns are copied as they lie in memory");

// Replaces `bytes` by those of a column.
template <typename Value>
void WriteColumn(const std::vector<Value>& column, std::string* bytes) {
  static_assert(std::is_trivially_copyable_v<Value>);
  bytes->assign(reinterpret_cast<const char*>(column.data()),
                column.size() * sizeof(Value));
}

// XXH3 (64 bits, seed 0) of columns, one after the other.
std::uint64_t ColumnChecksum(std::initializer_list<const std::string*> columns);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_COLUMN_BYTES_H_
