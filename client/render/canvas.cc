#include "client/render/canvas.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace terrane::client {
namespace {

// A regular face of fonts-dejavu-core; OpenImageIO looks it up by name.
constexpr char kFont[] = "DejaVuSans";

std::uint8_t ToByte(double value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0, 1.0) * 255 + 0.5);
}

// Distance of a point to the segment from `a` to `b`.
double DistanceTo(const PixelPoint& p, const PixelPoint& a,
                  const PixelPoint& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double along =
      length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2,
                               0.0, 1.0)
                  : 0.0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

}  // namespace

Rgb Mix(const Rgb& from, const Rgb& to, double share) {
  return {from.red + share * (to.red - from.red),
          from.green + share * (to.green - from.green),
          from.blue + share * (to.blue - from.blue)};
}

Picture Resized(const Picture& picture, int width, int height) {
  const OIIO::ImageBuf source(
      OIIO::ImageSpec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8),
      const_cast<std::uint8_t*>(picture.values.data()));
  Picture result(width, height, 3);
  OIIO::ImageBuf target(
      OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::UINT8),
      result.values.data());
  OIIO::ImageBufAlgo::resize(target, source, "triangle");
  return result;
}

Canvas::Canvas(int width, int height, const Rgb& background)
    : picture_(width, height, 3) {
  FillBox(0, 0, width, height, background);
}

void Canvas::SetPixel(int x, int y, const Rgb& colour) {
  std::uint8_t* pixel = picture_.Pixel(x, y);
  pixel[0] = ToByte(colour.red);
  pixel[1] = ToByte(colour.green);
  pixel[2] = ToByte(colour.blue);
}

void Canvas::Blend(int x, int y, const Rgb& colour, double cover) {
  if (x < 0 || y < 0 || x >= width() || y >= height() || cover <= 0) return;
  const std::uint8_t* pixel = picture_.Pixel(x, y);
  const Rgb under{pixel[0] / 255.0, pixel[1] / 255.0, pixel[2] / 255.0};
  SetPixel(x, y, Mix(under, colour, std::min(cover, 1.0)));
}

void Canvas::DrawLine(const PixelPoint& from, const PixelPoint& to,
                      double line_width, const Rgb& colour) {
  const double reach = line_width / 2 + 0.5;
  const auto first = [&](double a, double b) {
    return static_cast<int>(std::floor(std::min(a, b) - reach));
  };
  const auto last = [&](double a, double b) {
    return static_cast<int>(std::ceil(std::max(a, b) + reach));
  };
  for (int y = std::max(first(from.y, to.y), 0);
       y <= std::min(last(from.y, to.y), height() - 1); ++y) {
    for (int x = std::max(first(from.x, to.x), 0);
         x <= std::min(last(from.x, to.x), width() - 1); ++x) {
      Blend(x, y, colour, reach - DistanceTo({x + 0.5, y + 0.5}, from, to));
    }
  }
}

void Canvas::FillBox(int x, int y, int width, int height, const Rgb& colour) {
  for (int j = y; j < y + height; ++j) {
    for (int i = x; i < x + width; ++i) SetPixel(i, j, colour);
  }
}

void Canvas::Paste(const Picture& picture, int x, int y) {
  for (int j = 0; j < picture.height; ++j) {
    const std::uint8_t* row = picture.Pixel(0, j);
    std::copy(row, row + picture.width * 3, picture_.Pixel(x, y + j));
  }
}

void Canvas::DrawText(const PixelPoint& anchor, const std::string& text,
                      int size, TextAlign align, const Rgb& colour) {
  using OIIO::ImageBufAlgo::TextAlignX;
  const TextAlignX align_x = align == TextAlign::kLeft     ? TextAlignX::Left
                             : align == TextAlign::kMiddle ? TextAlignX::Center
                                                           : TextAlignX::Right;
  if (!HasFont()) return;
  // OpenImageIO draws into a buffer that wraps the picture's own memory. Digits
  // are 0.73 of the size high; their foot stands on the base line.
  OIIO::ImageBuf buffer(
      OIIO::ImageSpec(width(), height(), 3, OIIO::TypeDesc::UINT8),
      picture_.values.data());
  const std::array<float, 3> ink = {static_cast<float>(colour.red),
                                    static_cast<float>(colour.green),
                                    static_cast<float>(colour.blue)};
  OIIO::ImageBufAlgo::render_text(
      buffer, static_cast<int>(std::lround(anchor.x)),
      static_cast<int>(std::lround(anchor.y + 0.365 * size)), text, size, kFont,
      ink, align_x, OIIO::ImageBufAlgo::TextAlignY::Baseline);
}

int Canvas::TextWidth(const std::string& text, int size) {
  const OIIO::ROI box = OIIO::ImageBufAlgo::text_size(text, size, kFont);
  return box.defined() ? box.width() : 0;
}

bool Canvas::HasFont() {
  static const bool has_font = TextWidth("0", 12) > 0;
  return has_font;
}

}  // namespace terrane::client
