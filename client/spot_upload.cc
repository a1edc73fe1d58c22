#include "client/spot_upload.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

namespace terrane::client {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;

// The columns travel as they lie in memory.
static_assert(std::endian::native == std::endian::little);

}  // namespace

absl::Status SendSpotTable(
    const SpotTable& table,
    const std::function<absl::Status(const v1::UploadSpotTableRequest&)>&
        send) {
  v1::UploadSpotTableRequest part;
  part.mutable_header()->set_rows(static_cast<std::int64_t>(table.rows()));
  part.mutable_header()->set_has_standard_errors(!table.standard_error.empty());
  absl::Status status = send(part);
  for (const auto* column :
       {&table.x, &table.y, &table.height, &table.standard_error}) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(*column));
    for (std::size_t at = 0; status.ok() && at < bytes.size();
         at += kChunkBytes) {
      const std::span<const std::byte> chunk =
          bytes.subspan(at, std::min(kChunkBytes, bytes.size() - at));
      part.set_chunk(chunk.data(), chunk.size());
      status = send(part);
    }
  }
  return status;
}

}  // namespace terrane::client
