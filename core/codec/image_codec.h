// Images to the bytes of a PNG or OpenEXR file, through OpenImageIO. In memory:
// files are the caller's business. Lossless; the same image gives the same
// bytes. No gamma or colour profile chunk is written, so nobody rescales
// heights.
//
// Threads: any. Errors: INVALID_ARGUMENT for an empty image or a channel count
// other than 1 (grey, height) or 3 (RGB), INTERNAL when the library fails.
#ifndef TERRANE_CORE_CODEC_IMAGE_CODEC_H_
#define TERRANE_CORE_CODEC_IMAGE_CODEC_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/codec/image.h"

namespace terrane::core {

using EncodedImage = std::vector<unsigned char>;

// PNG of 8 bits a channel.
absl::StatusOr<EncodedImage> EncodePng(const Image<std::uint8_t>& image);
// PNG of 16 bits a channel.
absl::StatusOr<EncodedImage> EncodePng(const Image<std::uint16_t>& image);
// OpenEXR of 32-bit floats, ZIP compression; one channel is called Y.
absl::StatusOr<EncodedImage> EncodeExr(const Image<float>& image);

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_IMAGE_CODEC_H_
