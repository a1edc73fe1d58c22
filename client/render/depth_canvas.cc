#include "client/render/depth_canvas.h"

#include <limits>

namespace terrane::client {
namespace {

constexpr Rgb kPaper{1, 1, 1};

}  // namespace

DepthCanvas::DepthCanvas(int width, int height)
    : width_(width),
      height_(height),
      colours_(
          static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
          kPaper),
      distances_(colours_.size(), std::numeric_limits<double>::infinity()) {}

Canvas DepthCanvas::Shrunk() const {
  Canvas canvas(width_ / kSupersampling, height_ / kSupersampling, kPaper);
  constexpr double kShare = 1.0 / (kSupersampling * kSupersampling);
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      Rgb sum;
      for (int k = 0; k < kSupersampling * kSupersampling; ++k) {
        const int row = y * kSupersampling + k / kSupersampling;
        const int column = x * kSupersampling + k % kSupersampling;
        const Rgb& one = colours_[static_cast<std::size_t>(row) *
                                      static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(column)];
        sum = {sum.red + one.red, sum.green + one.green, sum.blue + one.blue};
      }
      canvas.SetPixel(
          x, y, {sum.red * kShare, sum.green * kShare, sum.blue * kShare});
    }
  }
  return canvas;
}

}  // namespace terrane::client
