// SpotTableSource: where a recipe's table of spot heights comes from.
#ifndef TERRANE_SERVER_CONVERT_SPOT_TABLE_SOURCE_H_
#define TERRANE_SERVER_CONVERT_SPOT_TABLE_SOURCE_H_

#include <memory>
#include <string>
#include <vector>

#include "core/terrain/terrain_spec.h"

namespace terrane::server {

using SpotTable = std::vector<core::SpotHeight>;

// Threads: FindTable may be called from any thread at any time.
class SpotTableSource {
 public:
  virtual ~SpotTableSource() = default;
  // Null: not kept.
  virtual std::shared_ptr<const SpotTable> FindTable(
      const std::string& table_id) = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_SPOT_TABLE_SOURCE_H_
