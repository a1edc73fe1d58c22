// DepthCanvas: triangles of a scene, the nearest one in every pixel.
//
// Coordinates are those of a finer raster, kSupersampling pixels for each of
// the picture that comes out; y runs down. Belongs to one thread.
#ifndef TERRANE_CLIENT_RENDER_DEPTH_CANVAS_H_
#define TERRANE_CLIENT_RENDER_DEPTH_CANVAS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "client/render/canvas.h"

namespace terrane::client {

// Every pixel of the picture is the mean of this many by this many.
inline constexpr int kSupersampling = 3;

// Where a vertex is drawn, and how far from the viewer it is.
struct DepthPoint {
  double x = 0;
  double y = 0;
  double distance = 0;
};

// The mean of three colours with these weights.
inline Rgb Mixed(const Rgb& a, double wa, const Rgb& b, double wb, const Rgb& c,
                 double wc) {
  return {wa * a.red + wb * b.red + wc * c.red,
          wa * a.green + wb * b.green + wc * c.green,
          wa * a.blue + wb * b.blue + wc * c.blue};
}

class DepthCanvas {
 public:
  // Width and height of the finer raster.
  DepthCanvas(int width, int height);

  // Draws a triangle; colour_of(wa, wb, wc) is the colour at the place with
  // these barycentric weights.
  template <typename ColourOf>
  void FillTriangle(const DepthPoint& a, const DepthPoint& b,
                    const DepthPoint& c, const ColourOf& colour_of) {
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0) return;
    const auto [min_x, max_x] = std::minmax({a.x, b.x, c.x});
    const auto [min_y, max_y] = std::minmax({a.y, b.y, c.y});
    for (int y = First(min_y); y <= Last(max_y, height_); ++y) {
      for (int x = First(min_x); x <= Last(max_x, width_); ++x) {
        const double px = x + 0.5;
        const double py = y + 0.5;
        const double wb =
            ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
        const double wc =
            ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
        const double wa = 1 - wb - wc;
        if (wa < 0 || wb < 0 || wc < 0) continue;
        const double distance =
            wa * a.distance + wb * b.distance + wc * c.distance;
        const std::size_t at =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(x);
        if (distance >= distances_[at]) continue;
        distances_[at] = distance;
        colours_[at] = colour_of(wa, wb, wc);
      }
    }
  }

  // The picture: means of kSupersampling squares, white where nothing is.
  Canvas Shrunk() const;

 private:
  static int First(double at) {
    return std::max(static_cast<int>(std::floor(at - 0.5)), 0);
  }
  static int Last(double at, int count) {
    return std::min(static_cast<int>(std::ceil(at)), count - 1);
  }

  int width_;
  int height_;
  std::vector<Rgb> colours_;
  std::vector<double> distances_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_DEPTH_CANVAS_H_
