// Columns of numbers as bytes, the form in which the API's messages carry them.
//
// The API's numbers are little-endian, and so is every machine that this is
// built for. Threads: pure functions.
#ifndef TERRANE_CORE_BASE_COLUMN_BYTES_H_
#define TERRANE_CORE_BASE_COLUMN_BYTES_H_

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace terrane::core {

static_assert(std::endian::native == std::endian::little,
              "columns are copied as they lie in memory");

// Replaces `bytes` by those of a column.
template <typename Value>
void WriteColumn(const std::vector<Value>& column, std::string* bytes) {
  static_assert(std::is_trivially_copyable_v<Value>);
  bytes->assign(reinterpret_cast<const char*>(column.data()),
                column.size() * sizeof(Value));
}

// Appends the elements that `bytes` are; what is left over after the last whole
// one is not read.
template <typename Value>
void AppendColumn(const std::string& bytes, std::vector<Value>* column) {
  static_assert(std::is_trivially_copyable_v<Value>);
  const std::size_t count = bytes.size() / sizeof(Value);
  if (count == 0) return;  // memcpy takes no null, not even for nothing
  const std::size_t before = column->size();
  column->resize(before + count);
  std::memcpy(column->data() + before, bytes.data(), count * sizeof(Value));
}

// Element `index` of a column, which must have it.
template <typename Value>
Value ElementOf(const std::string& bytes, std::int64_t index) {
  static_assert(std::is_trivially_copyable_v<Value>);
  Value value;
  std::memcpy(&value,
              bytes.data() + static_cast<std::size_t>(index) * sizeof(Value),
              sizeof(Value));
  return value;
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_BASE_COLUMN_BYTES_H_
