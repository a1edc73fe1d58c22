// What the height tiles of every generator share: generating into the message,
// measuring, encoding, the checksum. Threads: any; a tile belongs to one.
#ifndef TERRANE_SERVER_ACTOR_HEIGHT_TILE_H_
#define TERRANE_SERVER_ACTOR_HEIGHT_TILE_H_

#include <functional>
#include <span>

#include "absl/status/status.h"
#include "core/grid/lattice_window.h"
#include "server/convert/request_plan.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::server {

// Writes the heights of a window to a span of window.width * window.height.
using GenerateHeights = std::function<absl::Status(std::span<float>)>;

// Fills in the window, the encoding, the data and what is measured of it.
// `range` is that of a 16-bit encoding. Errors: those of `generate`.
absl::Status FillHeightTile(v1::HeightEncoding encoding,
                            const EncodingRange& range,
                            const core::Window& window,
                            const GenerateHeights& generate,
                            v1::HeightTile* tile);

void WriteWindow(const core::Window& window, v1::Window* message);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_HEIGHT_TILE_H_
