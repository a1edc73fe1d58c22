#include "client/surface_grid.h"

#include <cstring>
#include <string>
#include <utility>

#include "core/mesh/grid_mesh.h"

namespace terrane::client {
namespace {

// A mesh of more takes too much memory: 32 bytes a vertex, and its triangles.
constexpr std::int64_t kMaxSamples = std::int64_t{1} << 26;

// Copies the rows of a tile's column to where they belong in `whole`.
template <typename Value>
void CopyRows(const std::string& bytes, const v1::Window& tile,
              const v1::Window& window, std::vector<Value>* whole) {
  const auto row_bytes = static_cast<std::size_t>(tile.width()) * sizeof(Value);
  for (std::int64_t j = 0; j < tile.height(); ++j) {
    const std::int64_t to =
        (tile.y() - window.y() + j) * window.width() + tile.x() - window.x();
    std::memcpy(whole->data() + to,
                bytes.data() + static_cast<std::size_t>(j) * row_bytes,
                row_bytes);
  }
}

}  // namespace

absl::Status SurfaceGrid::AddHeader(const v1::SurfaceHeader& header) {
  header_ = header;
  const std::int64_t samples =
      header.window().width() * header.window().height();
  if (samples > kMaxSamples) {
    return absl::ResourceExhaustedError(
        "a mesh in memory has at most " + std::to_string(kMaxSamples) +
        " samples, got " + std::to_string(samples));
  }
  positions_.resize(static_cast<std::size_t>(samples));
  normals_.resize(static_cast<std::size_t>(samples));
  return absl::OkStatus();
}

absl::Status SurfaceGrid::AddTile(const v1::MeshTile& tile) {
  CopyRows(tile.positions(), tile.window(), header_.window(), &positions_);
  CopyRows(tile.normals(), tile.window(), header_.window(), &normals_);
  if (!tile.uvs().empty()) {
    uvs_.resize(positions_.size());
    CopyRows(tile.uvs(), tile.window(), header_.window(), &uvs_);
  }
  left_out_samples_ += tile.left_out_samples();
  return absl::OkStatus();
}

core::Mesh SurfaceGrid::MakeMesh() const {
  return core::MakeGridMesh({header_.window().width(),
                             header_.window().height(), positions_, normals_,
                             uvs_});
}

absl::StatusOr<SurfaceGrid> StreamToGrid(
    const v1::StreamSurfaceRequest& request, Backend* backend,
    std::stop_token stop) {
  SurfaceGrid grid;
  const absl::Status status = backend->StreamSurface(
      request,
      [&](const v1::SurfaceHeader& header) { return grid.AddHeader(header); },
      [&](const v1::StreamSurfaceResponse& message) {
        return grid.AddTile(message.mesh_tile());
      },
      std::move(stop));
  if (!status.ok()) return status;
  return grid;
}

}  // namespace terrane::client
