#include "core/codec/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

#include "absl/status/status.h"

namespace terrane::core {
namespace {

template <typename Value>
absl::StatusOr<EncodedImage> Encode(const Image<Value>& image,
                                    OIIO::TypeDesc type, const char* format,
                                    const char* compression) {
  if (image.width < 1 || image.height < 1) {
    return absl::InvalidArgumentError("image: must not be empty");
  }
  if (image.channels != 1 && image.channels != 3) {
    return absl::InvalidArgumentError("image.channels: must be 1 or 3, got " +
                                      std::to_string(image.channels));
  }
  OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
  spec.attribute("compression", compression);
  if (image.channels == 1) spec.channelnames = {"Y"};
  // Without it an EXR file holds the time of its making.
  spec.attribute("DateTime", "");

  EncodedImage bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output =
      OIIO::ImageOutput::create(format, &memory);
  if (output == nullptr) {
    return absl::InternalError("OpenImageIO: " + OIIO::geterror());
  }
  if (!output->open(format, spec) ||
      !output->write_image(type, image.values.data()) || !output->close()) {
    return absl::InternalError("OpenImageIO: " + output->geterror());
  }
  return bytes;
}

}  // namespace

absl::StatusOr<EncodedImage> EncodePng(const Image<std::uint8_t>& image) {
  return Encode(image, OIIO::TypeDesc::UINT8, "image.png", "zip");
}

absl::StatusOr<EncodedImage> EncodePng(const Image<std::uint16_t>& image) {
  return Encode(image, OIIO::TypeDesc::UINT16, "image.png", "zip");
}

absl::StatusOr<EncodedImage> EncodeExr(const Image<float>& image) {
  return Encode(image, OIIO::TypeDesc::FLOAT, "image.exr", "zip");
}

}  // namespace terrane::core
