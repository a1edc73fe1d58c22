// SurfaceGrid: a streamed mesh, in memory.
//
// Feed it the header and the tiles of a stream of MESH without shared edges;
// then it holds the samples of the header's window, row-major. Belongs to one
// thread. Errors: RESOURCE_EXHAUSTED for more samples than a file could index.
#ifndef TERRANE_CLIENT_SURFACE_GRID_H_
#define TERRANE_CLIENT_SURFACE_GRID_H_

#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/backend.h"
#include "core/mesh/mesh.h"
#include "terrane/v1/surface.pb.h"

namespace terrane::client {

class SurfaceGrid {
 public:
  absl::Status AddHeader(const v1::SurfaceHeader& header);
  absl::Status AddTile(const v1::MeshTile& tile);

  const v1::SurfaceHeader& header() const { return header_; }
  std::int64_t left_out_samples() const { return left_out_samples_; }

  // The triangles; texture coordinates where the tiles brought them.
  core::Mesh MakeMesh() const;

 private:
  v1::SurfaceHeader header_;
  std::vector<core::Float3> positions_;
  std::vector<core::Float3> normals_;
  std::vector<core::Float2> uvs_;
  std::int64_t left_out_samples_ = 0;
};

// Streams a request for a mesh into memory.
absl::StatusOr<SurfaceGrid> StreamToGrid(
    const v1::StreamSurfaceRequest& request, Backend* backend,
    std::stop_token stop);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SURFACE_GRID_H_
