#include "server/actor/spot_table_store.h"

#include <optional>

namespace terrane::server {

std::int64_t SpotTableBytes(std::int64_t rows) {
  return rows * std::int64_t{sizeof(core::SpotHeight)};
}

std::shared_ptr<const SpotTable> SpotTableStore::FindTable(
    const std::string& table_id) {
  const std::optional<StoredSpotTable> kept = Get(table_id);
  return kept.has_value() ? kept->table : nullptr;
}

}  // namespace terrane::server
