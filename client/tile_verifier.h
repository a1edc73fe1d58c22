// TileVerifier: holds every tile of a stream against what was asked for, so
// that nothing wrong reaches a file: order, total, place, size and checksum of
// the bytes. Errors: DATA_LOSS, naming what came and what was expected.
//
// Belongs to one stream and one thread.
#ifndef TERRANE_CLIENT_TILE_VERIFIER_H_
#define TERRANE_CLIENT_TILE_VERIFIER_H_

#include <cstdint>

#include "absl/status/status.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::client {

class TileVerifier {
 public:
  // `first_tile` of the request is the index that must come first.
  explicit TileVerifier(const v1::StreamTilesRequest& request)
      : from_window_(!request.has_tiles()),
        range_(request.tiles()),
        next_index_(request.first_tile()) {}

  // The header of the stream, or of its resumption: that one must describe the
  // same tiles.
  absl::Status CheckHeader(const v1::StreamHeader& header);
  // The next tile.
  absl::Status CheckTile(const v1::HeightTile& tile);
  // The end of the stream: all tiles must have come.
  absl::Status CheckEnd() const;

  // Index of the tile that must come next: where to resume.
  std::int64_t next_index() const { return next_index_; }
  bool has_header() const { return has_header_; }

 private:
  v1::Window ExpectedWindow(std::int64_t index) const;
  std::int64_t Total() const;

  bool from_window_;
  v1::TileRange range_;
  std::int64_t next_index_;
  bool has_header_ = false;
  v1::StreamHeader header_;
};

// Bytes of one sample.
std::int64_t BytesPerSample(v1::HeightEncoding encoding);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TILE_VERIFIER_H_
