#include "server/actor/height_tile.h"

// The same XXH3, in the vector instructions that this CPU has.
#include <xxh_x86dispatch.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/grid/height_codec.h"

namespace terrane::server {

void WriteWindow(const core::Window& window, v1::Window* message) {
  message->set_x(window.x);
  message->set_y(window.y);
  message->set_width(window.width);
  message->set_height(window.height);
}

absl::Status FillHeightTile(v1::HeightEncoding encoding,
                            const EncodingRange& range,
                            const core::Window& window,
                            const GenerateHeights& generate,
                            v1::HeightTile* tile) {
  const auto samples = static_cast<std::size_t>(window.width * window.height);
  // Floats are generated where they are sent from. A message that had a tile of
  // this size before keeps its bytes, which spares clearing them.
  core::HeightStats stats;
  std::string* const data = tile->mutable_data();
  if (encoding == v1::HEIGHT_ENCODING_UINT16_LE) {
    const auto heights = std::make_unique_for_overwrite<float[]>(samples);
    const std::span<float> span(heights.get(), samples);
    const absl::Status status = generate(span);
    if (!status.ok()) return status;
    stats = core::MeasureHeights(span);
    data->resize(samples * sizeof(std::uint16_t));
    tile->set_clipped_samples(core::EncodeUint16(
        span, range.minimum, range.maximum,
        {reinterpret_cast<std::uint16_t*>(data->data()), samples}));
  } else {
    data->resize(samples * sizeof(float));
    const std::span<float> span(reinterpret_cast<float*>(data->data()),
                                samples);
    const absl::Status status = generate(span);
    if (!status.ok()) return status;
    stats = core::MeasureHeights(span);
    tile->set_clipped_samples(0);
  }
  WriteWindow(window, tile->mutable_window());
  tile->set_encoding(encoding);
  tile->set_minimum(stats.minimum);
  tile->set_maximum(stats.maximum);
  tile->set_checksum(XXH3_64bits(data->data(), data->size()));
  tile->set_nodata_samples(stats.nodata_samples);
  return absl::OkStatus();
}

}  // namespace terrane::server
