// SurfaceVerifier: holds every tile of a surface stream against what was asked
// for, as TileVerifier does for terrain: order, total, place, size and checksum
// of the bytes. Errors: DATA_LOSS, naming what came and what was expected.
//
// Belongs to one stream and one thread.
#ifndef TERRANE_CLIENT_SURFACE_VERIFIER_H_
#define TERRANE_CLIENT_SURFACE_VERIFIER_H_

#include <cstdint>

#include "absl/status/status.h"
#include "terrane/v1/surface.pb.h"

namespace terrane::client {

class SurfaceVerifier {
 public:
  // `first_tile` of the request is the index that must come first.
  explicit SurfaceVerifier(const v1::StreamSurfaceRequest& request)
      : uvs_(request.uvs()), next_index_(request.first_tile()) {}

  // The header of the stream, or of its resumption: that one must describe the
  // same tiles.
  absl::Status CheckHeader(const v1::SurfaceHeader& header);
  // The next message, which holds a tile.
  absl::Status CheckTile(const v1::StreamSurfaceResponse& message);
  // The end of the stream: all tiles must have come.
  absl::Status CheckEnd() const;

  // Index of the tile that must come next: where to resume.
  std::int64_t next_index() const { return next_index_; }
  bool has_header() const { return has_header_; }

 private:
  v1::Window ExpectedWindow(std::int64_t index) const;
  std::int64_t Total() const;
  absl::Status CheckPlace(std::int64_t index, std::int64_t total,
                          const v1::Window& window) const;
  absl::Status CheckMesh(const v1::MeshTile& tile) const;
  absl::Status CheckHeights(const v1::HeightTile& tile) const;

  bool uvs_;
  std::int64_t next_index_;
  bool has_header_ = false;
  v1::SurfaceHeader header_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SURFACE_VERIFIER_H_
