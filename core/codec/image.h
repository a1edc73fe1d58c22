// Image: pixels in memory. Row-major, top row first, channels interleaved.
#ifndef TERRANE_CORE_CODEC_IMAGE_H_
#define TERRANE_CORE_CODEC_IMAGE_H_

#include <cstddef>
#include <vector>

namespace terrane::core {

template <typename Value>
struct Image {
  Image() = default;
  Image(int columns, int rows, int channel_count)
      : width(columns),
        height(rows),
        channels(channel_count),
        values(static_cast<std::size_t>(columns) *
               static_cast<std::size_t>(rows) *
               static_cast<std::size_t>(channel_count)) {}

  // First channel of the pixel in column x, row y.
  Value* Pixel(int x, int y) { return values.data() + Offset(x, y); }
  const Value* Pixel(int x, int y) const {
    return values.data() + Offset(x, y);
  }

  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<Value> values;

 private:
  std::size_t Offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_IMAGE_H_
