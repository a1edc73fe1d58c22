#include "client/memory_stream.h"

#include <cstring>

namespace terrane::client {
namespace {

absl::Status Prepare(const v1::StreamHeader& header, std::int64_t max_samples,
                     PlacedRaster* placed) {
  const v1::Window& window = header.window();
  if (window.width() > max_samples / window.height()) {
    return absl::InvalidArgumentError(
        "window: a picture takes at most " + std::to_string(max_samples) +
        " samples, got " + std::to_string(window.width()) + " x " +
        std::to_string(window.height()));
  }
  const v1::Frame& frame = header.frame();
  core::Raster& raster = placed->raster;
  raster.width = window.width();
  raster.height = window.height();
  raster.frame = {
      frame.origin_x() + static_cast<double>(window.x()) * frame.spacing_x(),
      frame.origin_y() + static_cast<double>(window.y()) * frame.spacing_y(),
      frame.spacing_x(), frame.spacing_y()};
  raster.values.resize(static_cast<std::size_t>(raster.width * raster.height));
  placed->crs = frame.crs();
  return absl::OkStatus();
}

void Insert(const v1::HeightTile& tile, const v1::Window& whole,
            core::Raster* raster) {
  const auto row_bytes =
      static_cast<std::size_t>(tile.window().width()) * sizeof(float);
  const char* from = tile.data().data();
  for (std::int64_t j = 0; j < tile.window().height(); ++j) {
    const std::int64_t at =
        (tile.window().y() - whole.y() + j) * raster->width +
        tile.window().x() - whole.x();
    std::memcpy(raster->values.data() + at, from, row_bytes);
    from += row_bytes;
  }
}

}  // namespace

absl::StatusOr<PlacedRaster> StreamToMemory(
    const v1::StreamTilesRequest& request, std::int64_t max_samples,
    Backend* backend, std::stop_token stop) {
  PlacedRaster placed;
  v1::Window whole;
  const absl::Status status = backend->StreamTiles(
      request,
      [&](const v1::StreamHeader& header) {
        whole = header.window();
        return Prepare(header, max_samples, &placed);
      },
      [&](const v1::HeightTile& tile) {
        Insert(tile, whole, &placed.raster);
        return absl::OkStatus();
      },
      stop);
  if (!status.ok()) return status;
  return placed;
}

}  // namespace terrane::client
