#include "client/render_verifier.h"

#include <xxhash.h>

#include <algorithm>
#include <string>

namespace terrane::client {
namespace {

absl::Status Wrong(const v1::RenderBand& band, const std::string& what) {
  return absl::DataLossError("band " + std::to_string(band.index()) + ": " +
                             what);
}

std::int64_t BytesOfPixel(v1::PixelEncoding encoding) {
  return encoding == v1::PIXEL_ENCODING_LINEAR_FLOAT32_LE ? 12 : 3;
}

}  // namespace

absl::Status RenderVerifier::CheckHeader(const v1::RenderHeader& header) {
  if (has_header_ &&
      header.SerializeAsString() != header_.SerializeAsString()) {
    return absl::FailedPreconditionError(
        "the server's answer changed between the parts of a resumed stream: "
        "another picture");
  }
  if (header.width() < 1 || header.height() < 1 || header.band_rows() < 1) {
    return absl::DataLossError("the header has no pixels");
  }
  header_ = header;
  has_header_ = true;
  return absl::OkStatus();
}

absl::Status RenderVerifier::CheckTile(
    const v1::StreamRenderResponse& message) {
  if (!has_header_) return absl::DataLossError("the stream has no header");
  if (message.has_progress()) return absl::OkStatus();
  const v1::RenderBand& band = message.band();
  if (band.index() != next_index_ || next_index_ >= header_.bands()) {
    return Wrong(band, "came where " + std::to_string(next_index_) + " of " +
                           std::to_string(header_.bands()) + " belongs");
  }
  const std::int64_t bands =
      (header_.height() + header_.band_rows() - 1) / header_.band_rows();
  const std::int64_t first_row = band.index() % bands * header_.band_rows();
  const std::int64_t rows =
      std::min<std::int64_t>(header_.band_rows(), header_.height() - first_row);
  if (band.first_row() != first_row || band.rows() != rows) {
    return Wrong(band, "has other rows than it should");
  }
  const std::int64_t expected =
      rows * header_.width() * BytesOfPixel(header_.encoding());
  if (static_cast<std::int64_t>(band.pixels().size()) != expected) {
    return Wrong(band, "has " + std::to_string(band.pixels().size()) +
                           " bytes of pixels, expected " +
                           std::to_string(expected));
  }
  if (XXH3_64bits(band.pixels().data(), band.pixels().size()) !=
      band.checksum()) {
    return Wrong(band, "does not match its checksum");
  }
  ++next_index_;
  return absl::OkStatus();
}

absl::Status RenderVerifier::CheckEnd() const {
  if (!has_header_) return absl::DataLossError("the stream had no header");
  if (next_index_ == header_.bands()) return absl::OkStatus();
  return absl::DataLossError("the stream ended after " +
                             std::to_string(next_index_) + " of " +
                             std::to_string(header_.bands()) + " bands");
}

}  // namespace terrane::client
