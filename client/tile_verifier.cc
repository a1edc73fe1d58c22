#include "client/tile_verifier.h"

#include <xxhash.h>

#include <algorithm>
#include <string>

namespace terrane::client {
namespace {

absl::Status Wrong(std::int64_t index, const std::string& what) {
  return absl::DataLossError("tile " + std::to_string(index) + ": " + what);
}

std::string Text(const v1::Window& window) {
  return std::to_string(window.x()) + "," + std::to_string(window.y()) + "," +
         std::to_string(window.width()) + "," + std::to_string(window.height());
}

bool SameTiles(const v1::StreamHeader& a, const v1::StreamHeader& b) {
  return a.recipe_hash() == b.recipe_hash() && a.revision() == b.revision() &&
         a.level() == b.level() && a.sampling() == b.sampling() &&
         a.encoding() == b.encoding() && a.tile_size() == b.tile_size() &&
         a.range().minimum() == b.range().minimum() &&
         a.range().maximum() == b.range().maximum() &&
         Text(a.window()) == Text(b.window());
}

}  // namespace

std::int64_t BytesPerSample(v1::HeightEncoding encoding) {
  return encoding == v1::HEIGHT_ENCODING_UINT16_LE ? 2 : 4;
}

absl::Status TileVerifier::CheckHeader(const v1::StreamHeader& header) {
  if (has_header_ && !SameTiles(header_, header)) {
    return absl::FailedPreconditionError(
        "the server's answer changed between the parts of a resumed stream: "
        "another recipe or algorithm revision");
  }
  if (header.tile_size() < 1 || header.tile_columns() < 1 ||
      header.tile_rows() < 1) {
    return absl::DataLossError("the stream's header names no tiles");
  }
  header_ = header;
  has_header_ = true;
  return absl::OkStatus();
}

absl::Status TileVerifier::CheckTile(const v1::HeightTile& tile) {
  if (!has_header_) return Wrong(tile.index(), "came before the header");
  if (tile.index() != next_index_) {
    return Wrong(tile.index(),
                 "came where tile " + std::to_string(next_index_) + " belongs");
  }
  if (tile.index() >= Total() || tile.total() != Total()) {
    return Wrong(tile.index(), "is one of " + std::to_string(tile.total()) +
                                   ", expected " + std::to_string(Total()));
  }
  const v1::Window expected = ExpectedWindow(tile.index());
  if (Text(tile.window()) != Text(expected)) {
    return Wrong(tile.index(), "covers " + Text(tile.window()) + ", expected " +
                                   Text(expected));
  }
  const std::int64_t bytes =
      expected.width() * expected.height() * BytesPerSample(header_.encoding());
  if (static_cast<std::int64_t>(tile.data().size()) != bytes) {
    return Wrong(tile.index(), "has " + std::to_string(tile.data().size()) +
                                   " bytes, expected " + std::to_string(bytes));
  }
  if (XXH3_64bits(tile.data().data(), tile.data().size()) != tile.checksum()) {
    return Wrong(tile.index(), "does not match its checksum");
  }
  ++next_index_;
  return absl::OkStatus();
}

absl::Status TileVerifier::CheckEnd() const {
  if (!has_header_) return absl::DataLossError("the stream had no header");
  if (next_index_ < Total()) {
    return absl::DataLossError("the stream ended after " +
                               std::to_string(next_index_) + " of " +
                               std::to_string(Total()) + " tiles");
  }
  return absl::OkStatus();
}

std::int64_t TileVerifier::Total() const {
  return header_.tile_columns() * header_.tile_rows();
}

v1::Window TileVerifier::ExpectedWindow(std::int64_t index) const {
  const std::int64_t column = index % header_.tile_columns();
  const std::int64_t row = index / header_.tile_columns();
  const std::int64_t size = header_.tile_size();
  v1::Window window;
  if (from_window_) {
    const v1::Window& whole = header_.window();
    window.set_x(whole.x() + column * size);
    window.set_y(whole.y() + row * size);
    window.set_width(std::min(size, whole.width() - column * size));
    window.set_height(std::min(size, whole.height() - row * size));
    return window;
  }
  // Neighbouring POINT tiles share an edge.
  const std::int64_t stride =
      header_.sampling() == v1::SAMPLING_AREA ? size : size - 1;
  window.set_x((range_.x() + column) * stride);
  window.set_y((range_.y() + row) * stride);
  window.set_width(size);
  window.set_height(size);
  return window;
}

}  // namespace terrane::client
