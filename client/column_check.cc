#include "client/column_check.h"

#include <xxhash.h>

#include <memory>

namespace terrane::client {

absl::Status WrongBlock(const std::string& block, const std::string& what) {
  return absl::DataLossError(block + ": " + what);
}

absl::Status CheckColumns(const std::string& block,
                          std::initializer_list<Column> columns,
                          std::uint64_t checksum) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(
      XXH3_createState(), &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  for (const Column& column : columns) {
    const auto size = static_cast<std::int64_t>(column.bytes.size());
    if (size != column.expected) {
      return WrongBlock(block, "has " + std::to_string(size) + " bytes of " +
                                   column.name + ", expected " +
                                   std::to_string(column.expected));
    }
    XXH3_64bits_update(state.get(), column.bytes.data(), column.bytes.size());
  }
  if (XXH3_64bits_digest(state.get()) != checksum) {
    return WrongBlock(block, "does not match its checksum");
  }
  return absl::OkStatus();
}

absl::Status CheckPlace(const std::string& block, std::int64_t came,
                        std::int64_t expected) {
  if (came == expected) return absl::OkStatus();
  return WrongBlock(block,
                    "came where " + std::to_string(expected) + " belongs");
}

}  // namespace terrane::client
