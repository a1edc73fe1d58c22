// Canvas: an 8-bit RGB picture to draw on: antialiased lines, filled boxes and
// text in DejaVu Sans. Coordinates are pixels, x to the right, y down; the
// centre of the first pixel is at (0.5, 0.5). Belongs to one thread.
#ifndef TERRANE_CLIENT_RENDER_CANVAS_H_
#define TERRANE_CLIENT_RENDER_CANVAS_H_

#include <cstdint>
#include <string>

#include "core/codec/image.h"

namespace terrane::client {

struct Rgb {
  double red = 0;  // 0 to 1
  double green = 0;
  double blue = 0;

  bool operator==(const Rgb&) const = default;
};

Rgb Mix(const Rgb& from, const Rgb& to, double share);

using Picture = core::Image<std::uint8_t>;

// The picture at another size, each pixel a weighted mean of those it covers.
Picture Resized(const Picture& picture, int width, int height);

struct PixelPoint {
  double x = 0;
  double y = 0;
};

// Where a text is put relative to its anchor: left, middle or right of the text
// at the anchor's x; the anchor's y is the middle of the digits' height.
enum class TextAlign { kLeft, kMiddle, kRight };

class Canvas {
 public:
  Canvas(int width, int height, const Rgb& background);

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }

  void SetPixel(int x, int y, const Rgb& colour);
  // Lays the colour over the pixel; `cover` 0 to 1. Outside the canvas:
  // nothing.
  void Blend(int x, int y, const Rgb& colour, double cover);
  void DrawLine(const PixelPoint& from, const PixelPoint& to, double line_width,
                const Rgb& colour);
  void FillBox(int x, int y, int width, int height, const Rgb& colour);
  // Copies a picture to where its first pixel is (x, y).
  void Paste(const Picture& picture, int x, int y);

  void DrawText(const PixelPoint& anchor, const std::string& text, int size,
                TextAlign align, const Rgb& colour);
  // Width of a text in pixels.
  static int TextWidth(const std::string& text, int size);
  // False when the font is not installed: texts are then left out.
  static bool HasFont();

  const Picture& picture() const { return picture_; }

 private:
  Picture picture_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_CANVAS_H_
