#include "client/surface_verifier.h"

#include <xxhash.h>

#include <algorithm>
#include <string>

#include "client/tile_verifier.h"

namespace terrane::client {
namespace {

absl::Status Wrong(std::int64_t index, const std::string& what) {
  return absl::DataLossError("tile " + std::to_string(index) + ": " + what);
}

std::string Text(const v1::Window& window) {
  return std::to_string(window.x()) + "," + std::to_string(window.y()) + "," +
         std::to_string(window.width()) + "," + std::to_string(window.height());
}

bool SameTiles(const v1::SurfaceHeader& a, const v1::SurfaceHeader& b) {
  return a.recipe_hash() == b.recipe_hash() && a.revision() == b.revision() &&
         a.columns() == b.columns() && a.rows() == b.rows() &&
         a.output() == b.output() && a.tile_size() == b.tile_size() &&
         a.share_edges() == b.share_edges() && a.encoding() == b.encoding() &&
         Text(a.window()) == Text(b.window());
}

absl::Status CheckBytes(std::int64_t index, const char* what,
                        const std::string& bytes, std::int64_t expected) {
  if (static_cast<std::int64_t>(bytes.size()) == expected) {
    return absl::OkStatus();
  }
  return Wrong(index, "has " + std::to_string(bytes.size()) + " bytes of " +
                          what + ", expected " + std::to_string(expected));
}

}  // namespace

absl::Status SurfaceVerifier::CheckHeader(const v1::SurfaceHeader& header) {
  if (has_header_ && !SameTiles(header_, header)) {
    return absl::FailedPreconditionError(
        "the server's answer changed between the parts of a resumed stream: "
        "another recipe or algorithm revision");
  }
  if (header.tile_size() < (header.share_edges() ? 2 : 1) ||
      header.tile_columns() < 1 || header.tile_rows() < 1) {
    return absl::DataLossError("the stream's header names no tiles");
  }
  header_ = header;
  has_header_ = true;
  return absl::OkStatus();
}

absl::Status SurfaceVerifier::CheckTile(
    const v1::StreamSurfaceResponse& message) {
  if (!has_header_) return Wrong(next_index_, "came before the header");
  const bool heights = header_.output() == v1::SURFACE_OUTPUT_HEIGHTS;
  if (heights ? !message.has_height_tile() : !message.has_mesh_tile()) {
    return Wrong(next_index_, "is not what the header announces");
  }
  const absl::Status status = heights ? CheckHeights(message.height_tile())
                                      : CheckMesh(message.mesh_tile());
  if (status.ok()) ++next_index_;
  return status;
}

absl::Status SurfaceVerifier::CheckPlace(std::int64_t index, std::int64_t total,
                                         const v1::Window& window) const {
  if (index != next_index_) {
    return Wrong(index,
                 "came where tile " + std::to_string(next_index_) + " belongs");
  }
  if (index >= Total() || total != Total()) {
    return Wrong(index, "is one of " + std::to_string(total) + ", expected " +
                            std::to_string(Total()));
  }
  const v1::Window expected = ExpectedWindow(index);
  if (Text(window) != Text(expected)) {
    return Wrong(index,
                 "covers " + Text(window) + ", expected " + Text(expected));
  }
  return absl::OkStatus();
}

absl::Status SurfaceVerifier::CheckMesh(const v1::MeshTile& tile) const {
  absl::Status status = CheckPlace(tile.index(), tile.total(), tile.window());
  if (!status.ok()) return status;
  const std::int64_t samples = tile.window().width() * tile.window().height();
  const auto check = [&](const char* what, const std::string& bytes,
                         std::int64_t channels) {
    if (!status.ok()) return;
    status = CheckBytes(tile.index(), what, bytes,
                        samples * channels * std::int64_t{sizeof(float)});
  };
  check("positions", tile.positions(), 3);
  check("normals", tile.normals(), 3);
  check("texture coordinates", tile.uvs(), uvs_ ? 2 : 0);
  if (!status.ok()) return status;
  const std::string columns = tile.positions() + tile.normals() + tile.uvs();
  if (XXH3_64bits(columns.data(), columns.size()) != tile.checksum()) {
    return Wrong(tile.index(), "does not match its checksum");
  }
  return absl::OkStatus();
}

absl::Status SurfaceVerifier::CheckHeights(const v1::HeightTile& tile) const {
  absl::Status status = CheckPlace(tile.index(), tile.total(), tile.window());
  if (!status.ok()) return status;
  const std::int64_t samples = tile.window().width() * tile.window().height();
  status = CheckBytes(tile.index(), "heights", tile.data(),
                      samples * BytesPerSample(header_.encoding()));
  if (!status.ok()) return status;
  if (XXH3_64bits(tile.data().data(), tile.data().size()) != tile.checksum()) {
    return Wrong(tile.index(), "does not match its checksum");
  }
  return absl::OkStatus();
}

absl::Status SurfaceVerifier::CheckEnd() const {
  if (!has_header_) return absl::DataLossError("the stream had no header");
  if (next_index_ < Total()) {
    return absl::DataLossError("the stream ended after " +
                               std::to_string(next_index_) + " of " +
                               std::to_string(Total()) + " tiles");
  }
  return absl::OkStatus();
}

std::int64_t SurfaceVerifier::Total() const {
  return header_.tile_columns() * header_.tile_rows();
}

v1::Window SurfaceVerifier::ExpectedWindow(std::int64_t index) const {
  const std::int64_t size = header_.tile_size();
  const std::int64_t stride = size - (header_.share_edges() ? 1 : 0);
  const std::int64_t x = index % header_.tile_columns() * stride;
  const std::int64_t y = index / header_.tile_columns() * stride;
  const v1::Window& whole = header_.window();
  v1::Window window;
  window.set_x(whole.x() + x);
  window.set_y(whole.y() + y);
  window.set_width(std::min(size, whole.width() - x));
  window.set_height(std::min(size, whole.height() - y));
  return window;
}

}  // namespace terrane::client
