#include "client/raster_upload.h"

#include <algorithm>
#include <bit>
#include <span>

namespace terrane::client {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;

// The samples travel as they lie in memory.
static_assert(std::endian::native == std::endian::little);

}  // namespace

absl::Status SendRaster(
    const core::Raster& raster,
    const std::function<absl::Status(const v1::UploadRasterRequest&)>& send) {
  v1::UploadRasterRequest part;
  v1::RasterHeader* header = part.mutable_header();
  header->set_width(raster.width);
  header->set_height(raster.height);
  header->mutable_frame()->set_origin_x(raster.frame.origin_x);
  header->mutable_frame()->set_origin_y(raster.frame.origin_y);
  header->mutable_frame()->set_spacing_x(raster.frame.spacing_x);
  header->mutable_frame()->set_spacing_y(raster.frame.spacing_y);
  absl::Status status = send(part);
  const std::span<const std::byte> bytes =
      std::as_bytes(std::span(raster.values));
  for (std::size_t at = 0; status.ok() && at < bytes.size();
       at += kChunkBytes) {
    const std::span<const std::byte> chunk =
        bytes.subspan(at, std::min(kChunkBytes, bytes.size() - at));
    part.set_chunk(chunk.data(), chunk.size());
    status = send(part);
  }
  return status;
}

}  // namespace terrane::client
