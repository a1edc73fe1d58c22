// A stream of tiles into one raster in memory, for pictures.
#ifndef TERRANE_CLIENT_MEMORY_STREAM_H_
#define TERRANE_CLIENT_MEMORY_STREAM_H_

#include <cstdint>
#include <stop_token>

#include "absl/status/statusor.h"
#include "client/backend.h"
#include "client/placed_raster.h"

namespace terrane::client {

// The request must be for FLOAT32 and a window or a whole domain. Error beyond
// those of the stream: INVALID_ARGUMENT for more than `max_samples`.
absl::StatusOr<PlacedRaster> StreamToMemory(
    const v1::StreamTilesRequest& request, std::int64_t max_samples,
    Backend* backend, std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_MEMORY_STREAM_H_
