// SpotTableStore: uploaded tables of spot heights in memory, named by their
// content (server/actor/content_store.h). Threads: every method from any
// thread.
#ifndef TERRANE_SERVER_ACTOR_SPOT_TABLE_STORE_H_
#define TERRANE_SERVER_ACTOR_SPOT_TABLE_STORE_H_

#include <cstdint>
#include <memory>
#include <string>

#include "server/actor/content_store.h"
#include "server/convert/spot_table_source.h"
#include "terrane/v1/spot_table.pb.h"

namespace terrane::server {

// A table as it was uploaded.
struct StoredSpotTable {
  std::shared_ptr<const SpotTable> table;
  // The answer to GetSpotTable: id and header.
  v1::GetSpotTableResponse description;
};

class SpotTableStore : public ContentStore<StoredSpotTable>,
                       public SpotTableSource {
 public:
  using ContentStore::ContentStore;

  std::shared_ptr<const SpotTable> FindTable(
      const std::string& table_id) override;
};

// Bytes of a table of so many rows.
std::int64_t SpotTableBytes(std::int64_t rows);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_SPOT_TABLE_STORE_H_
