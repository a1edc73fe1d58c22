#include "server/convert/column_checksum.h"

#include <xxh_x86dispatch.h>

#include <memory>

namespace terrane::server {

std::uint64_t ColumnChecksum(
    std::initializer_list<const std::string*> columns) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(
      XXH3_createState(), &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  for (const std::string* column : columns) {
    XXH3_64bits_update(state.get(), column->data(), column->size());
  }
  return XXH3_64bits_digest(state.get());
}

}  // namespace terrane::server
