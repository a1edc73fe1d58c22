#include "client/render/side_by_side.h"

#include <algorithm>
#include <cmath>

#include "client/render/relief.h"

namespace terrane::client {
namespace {

constexpr Rgb kPaper{1, 1, 1};
constexpr Rgb kInk{0.15, 0.15, 0.17};
constexpr Rgb kDetailFrame{0.85, 0.20, 0.15};
constexpr int kGap = 16;
constexpr int kCaptionHeight = 40;
constexpr int kCaptionSize = 20;
constexpr int kSmallestCaptionSize = 8;

// A hillshade whose pixels are still the samples, and the ground it covers.
struct Shaded {
  Picture picture;
  double width_m = 0;
  double height_m = 0;
};

Shaded Shade(const Panel& panel, const SideBySideOptions& options) {
  const core::GroundSpacing& spacing =
      panel.scale->Row(panel.heights.height / 2);
  ReliefOptions relief;
  relief.style = ReliefStyle::kHillshade;
  relief.light = options.light;
  relief.exaggeration = options.exaggeration;
  return {RenderRelief(panel.heights, *panel.scale, relief),
          spacing.x * static_cast<double>(panel.heights.width),
          spacing.y * static_cast<double>(panel.heights.height)};
}

// A share of a picture around its middle, at another size. Grown pixels stay
// squares: they are the posts.
Picture Part(const Picture& picture, double share, int width, int height) {
  const double part_width = picture.width * share;
  const double part_height = picture.height * share;
  const double first_x = (picture.width - part_width) / 2;
  const double first_y = (picture.height - part_height) / 2;
  if (part_width > width) {
    Picture cut(static_cast<int>(part_width), static_cast<int>(part_height), 3);
    for (int y = 0; y < cut.height; ++y) {
      const std::uint8_t* from = picture.Pixel(static_cast<int>(first_x),
                                               static_cast<int>(first_y) + y);
      std::copy(from, from + cut.width * 3, cut.Pixel(0, y));
    }
    return Resized(cut, width, height);
  }
  Picture result(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto from_x =
          static_cast<int>(first_x + (x + 0.5) * part_width / width);
      const auto from_y =
          static_cast<int>(first_y + (y + 0.5) * part_height / height);
      const std::uint8_t* from = picture.Pixel(from_x, from_y);
      std::copy(from, from + 3, result.Pixel(x, y));
    }
  }
  return result;
}

void DrawFrame(double x, double y, double width, double height,
               Canvas* canvas) {
  const PixelPoint a{x, y}, b{x + width, y}, c{x + width, y + height},
      d{x, y + height};
  canvas->DrawLine(a, b, 2.5, kDetailFrame);
  canvas->DrawLine(b, c, 2.5, kDetailFrame);
  canvas->DrawLine(c, d, 2.5, kDetailFrame);
  canvas->DrawLine(d, a, 2.5, kDetailFrame);
}

// The size at which both captions fit above their panels, if one does.
int CaptionSize(const Panel& left, const Panel& right, int panel_width) {
  int size = kCaptionSize;
  while (size > kSmallestCaptionSize &&
         std::max(Canvas::TextWidth(left.caption, size),
                  Canvas::TextWidth(right.caption, size)) > panel_width) {
    --size;
  }
  return size;
}

int Pixels(double metres, double metres_per_pixel) {
  return std::max(static_cast<int>(std::lround(metres / metres_per_pixel)), 1);
}

}  // namespace

Picture RenderSideBySide(const Panel& left, const Panel& right,
                         const SideBySideOptions& options) {
  const Shaded shaded[] = {Shade(left, options), Shade(right, options)};
  const Panel* panels[] = {&left, &right};
  const double metres_per_pixel =
      std::max(shaded[0].width_m, shaded[1].width_m) / options.panel_width;
  const int panel_height = Pixels(
      std::max(shaded[0].height_m, shaded[1].height_m), metres_per_pixel);
  const int caption_size = CaptionSize(left, right, options.panel_width);
  Canvas canvas(2 * options.panel_width + 3 * kGap,
                2 * (panel_height + kGap) + kCaptionHeight, kPaper);
  for (int side = 0; side < 2; ++side) {
    const Shaded& one = shaded[side];
    const int x = kGap + side * (options.panel_width + kGap);
    const int width = Pixels(one.width_m, metres_per_pixel);
    const int height = Pixels(one.height_m, metres_per_pixel);
    // The same piece of ground on both sides.
    const double share =
        std::min(options.detail_share * shaded[0].width_m / one.width_m, 1.0);
    canvas.DrawText({static_cast<double>(x), kCaptionHeight / 2.0},
                    panels[side]->caption, caption_size, TextAlign::kLeft,
                    kInk);
    canvas.Paste(Part(one.picture, 1, width, height), x, kCaptionHeight);
    DrawFrame(x + width * (1 - share) / 2,
              kCaptionHeight + height * (1 - share) / 2, width * share,
              height * share, &canvas);
    canvas.Paste(
        Part(one.picture, share, options.panel_width,
             std::min(static_cast<int>(std::lround(options.panel_width *
                                                   one.height_m / one.width_m)),
                      panel_height)),
        x, kCaptionHeight + panel_height + kGap);
  }
  return canvas.picture();
}

}  // namespace terrane::client
