#include "client/render/side_by_side.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

// The largest size at which every caption fits above its panel, if one does.
int CaptionSize(std::span<const Panel> panels, int panel_width) {
  const auto fits = [&](int size) {
    return std::ranges::all_of(panels, [&](const Panel& panel) {
      return Canvas::TextWidth(panel.caption, size) <= panel_width;
    });
  };
  int size = kCaptionSize;
  while (size > kSmallestCaptionSize && !fits(size)) --size;
  return size;
}

int Pixels(double metres, double metres_per_pixel) {
  return std::max(static_cast<int>(std::lround(metres / metres_per_pixel)), 1);
}

// One panel from x on: its whole, framed where the detail is, and the detail.
void DrawPanel(const Shaded& shaded, int x, int panel_height,
               double metres_per_pixel, double share,
               const SideBySideOptions& options, Canvas* canvas) {
  const int width = Pixels(shaded.width_m, metres_per_pixel);
  const int height = Pixels(shaded.height_m, metres_per_pixel);
  canvas->Paste(Part(shaded.picture, 1, width, height), x, kCaptionHeight);
  DrawFrame(x + width * (1 - share) / 2,
            kCaptionHeight + height * (1 - share) / 2, width * share,
            height * share, canvas);
  const auto detail_height = static_cast<int>(
      std::lround(options.panel_width * shaded.height_m / shaded.width_m));
  canvas->Paste(Part(shaded.picture, share, options.panel_width,
                     std::min(detail_height, panel_height)),
                x, kCaptionHeight + panel_height + kGap);
}

}  // namespace

Picture RenderSideBySide(std::span<const Panel> panels,
                         const SideBySideOptions& options) {
  std::vector<Shaded> shaded;
  double width_m = 0;
  double height_m = 0;
  for (const Panel& panel : panels) {
    shaded.push_back(Shade(panel, options));
    width_m = std::max(width_m, shaded.back().width_m);
    height_m = std::max(height_m, shaded.back().height_m);
  }
  const double metres_per_pixel = width_m / options.panel_width;
  const int panel_height = Pixels(height_m, metres_per_pixel);
  const int caption_size = CaptionSize(panels, options.panel_width);
  const int count = static_cast<int>(panels.size());
  Canvas canvas(count * (options.panel_width + kGap) + kGap,
                2 * (panel_height + kGap) + kCaptionHeight, kPaper);
  int x = kGap;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    canvas.DrawText({static_cast<double>(x), kCaptionHeight / 2.0},
                    panels[i].caption, caption_size, TextAlign::kLeft, kInk);
    // The same piece of ground in every panel.
    const double share = std::min(
        options.detail_share * shaded[0].width_m / shaded[i].width_m, 1.0);
    DrawPanel(shaded[i], x, panel_height, metres_per_pixel, share, options,
              &canvas);
    x += options.panel_width + kGap;
  }
  return canvas.picture();
}

}  // namespace terrane::client
