#include "client/traced_picture.h"

#include <cstring>
#include <filesystem>
#include <span>
#include <utility>

#include "client/output_file.h"
#include "core/codec/image_codec.h"

namespace terrane::client {
namespace {

bool IsExr(const std::string& path) {
  return std::filesystem::path(path).extension() == ".exr";
}

// Streams the finished picture alone. `Value` is what its encoding holds.
template <typename Value>
absl::StatusOr<core::Image<Value>> StreamPicture(
    const v1::StreamRenderRequest& request, ProgressMode mode,
    RenderBackend* backend, std::stop_token stop) {
  core::Image<Value> image;
  ShareProgress progress(mode, "rendered", "rendering");
  const auto on_header = [&](const v1::RenderHeader& header) {
    image = core::Image<Value>(header.width(), header.height(), 3);
    return absl::OkStatus();
  };
  const auto on_part = [&](const v1::StreamRenderResponse& part) {
    if (part.has_progress()) {
      progress.Show(part.progress().share());
    } else {
      const v1::RenderBand& band = part.band();
      std::memcpy(image.Pixel(0, band.first_row()), band.pixels().data(),
                  band.pixels().size());
    }
    return absl::OkStatus();
  };
  const absl::Status status =
      backend->StreamRender(request, on_header, on_part, std::move(stop));
  if (!status.ok()) return status;
  return image;
}

template <typename Value, typename Encode>
absl::StatusOr<core::EncodedImage> EncodedPicture(
    const v1::StreamRenderRequest& request, ProgressMode mode,
    RenderBackend* backend, std::stop_token stop, const Encode& encode) {
  const auto image =
      StreamPicture<Value>(request, mode, backend, std::move(stop));
  if (!image.ok()) return image.status();
  return encode(*image);
}

}  // namespace

bool IsTracedFile(const std::string& path) {
  return IsExr(path) || std::filesystem::path(path).extension() == ".png";
}

absl::Status WriteTracedPicture(v1::StreamRenderRequest request,
                                const std::string& path, ProgressMode mode,
                                RenderBackend* backend, std::stop_token stop) {
  request.set_final_only(true);
  absl::StatusOr<core::EncodedImage> bytes;
  if (IsExr(path)) {
    request.set_encoding(v1::PIXEL_ENCODING_LINEAR_FLOAT32_LE);
    bytes = EncodedPicture<float>(
        request, mode, backend, std::move(stop),
        [](const core::Image<float>& image) { return core::EncodeExr(image); });
  } else {
    bytes = EncodedPicture<std::uint8_t>(
        request, mode, backend, std::move(stop),
        [](const core::Image<std::uint8_t>& image) {
          return core::EncodePng(image);
        });
  }
  if (!bytes.ok()) return bytes.status();
  return WriteFile(path, std::as_bytes(std::span(*bytes)));
}

}  // namespace terrane::client
