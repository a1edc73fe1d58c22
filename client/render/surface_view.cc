#include "client/render/surface_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "client/render/depth_canvas.h"

namespace terrane::client {
namespace {

constexpr Rgb kGround{0.80, 0.70, 0.54};
// From linear light to what a screen shows.
constexpr double kDisplayPower = 1 / 2.2;
constexpr Rgb kNetLine{0.16, 0.32, 0.55};
constexpr double kNetLineWidth = 1.6;
constexpr double kDotWidth = 7;
constexpr double kMarginShare = 0.04;
// What a side has that the light does not reach.
constexpr double kAmbient = 0.25;

// Where the viewer stands: a parallel projection that fills the picture.
class Viewpoint {
 public:
  explicit Viewpoint(const SurfaceViewOptions& options) {
    const double turn = options.turn_deg * std::numbers::pi / 180;
    const double tilt = options.tilt_deg * std::numbers::pi / 180;
    right_x_ = std::cos(turn);
    right_y_ = -std::sin(turn);
    up_x_ = std::sin(turn) * std::sin(tilt);
    up_y_ = std::cos(turn) * std::sin(tilt);
    up_z_ = std::cos(tilt);
    exaggeration_ = options.exaggeration;
  }

  // Widens the view so that it holds the point.
  void Include(const core::Float3& point) {
    const DepthPoint seen = Seen(point);
    min_x_ = std::min(min_x_, seen.x);
    max_x_ = std::max(max_x_, seen.x);
    min_y_ = std::min(min_y_, seen.y);
    max_y_ = std::max(max_y_, seen.y);
  }

  // Fits what was included into pictures of this width, and of this height at
  // most.
  void Fit(int width, int most_height) {
    const double margin = kMarginShare * width;
    const double extent = std::max(max_x_ - min_x_, 1e-30);
    const double rise = max_y_ - min_y_;
    scale_ = (width - 2 * margin) / extent;
    left_ = top_ = margin;
    if (most_height > 0 && rise * scale_ > most_height - 2 * margin) {
      scale_ = (most_height - 2 * margin) / rise;
      left_ = (width - extent * scale_) / 2;
    }
    height_ = std::clamp(
        static_cast<int>(std::ceil(rise * scale_ + 2 * margin)), 1, 8 * width);
  }

  int height() const { return height_; }

  // Pixels, y down.
  DepthPoint Project(const core::Float3& point) const {
    const DepthPoint seen = Seen(point);
    return {left_ + (seen.x - min_x_) * scale_,
            top_ + (max_y_ - seen.y) * scale_, seen.distance};
  }

 private:
  DepthPoint Seen(const core::Float3& p) const {
    const double x = static_cast<double>(p.x);
    const double y = static_cast<double>(p.y);
    const double z = static_cast<double>(p.z) * exaggeration_;
    // Away from the viewer: up x right, whose z is 0.
    const double away_x = -up_z_ * right_y_;
    const double away_y = up_z_ * right_x_;
    const double away_z = up_x_ * right_y_ - up_y_ * right_x_;
    return {x * right_x_ + y * right_y_, x * up_x_ + y * up_y_ + z * up_z_,
            x * away_x + y * away_y + z * away_z};
  }

  double right_x_, right_y_;
  double up_x_, up_y_, up_z_;
  double exaggeration_;
  double min_x_ = std::numeric_limits<double>::infinity();
  double max_x_ = -std::numeric_limits<double>::infinity();
  double min_y_ = std::numeric_limits<double>::infinity();
  double max_y_ = -std::numeric_limits<double>::infinity();
  double left_ = 0;  // of what is seen, in pixels
  double top_ = 0;
  double scale_ = 1;
  int height_ = 1;
};

Rgb ColourOf(const core::Mesh& mesh, std::size_t vertex) {
  if (mesh.colors.empty()) return kGround;
  const core::Float3& linear = mesh.colors[vertex];
  const auto shown = [](float part) {
    return std::pow(static_cast<double>(part), kDisplayPower);
  };
  return {shown(linear.x), shown(linear.y), shown(linear.z)};
}

Rgb Shaded(const Rgb& colour, const core::Float3& normal,
           const SurfaceViewOptions& options) {
  // Heights that are stretched flatten the normal.
  const double x = static_cast<double>(normal.x);
  const double y = static_cast<double>(normal.y);
  const double z = static_cast<double>(normal.z) / options.exaggeration;
  const core::Light& light = options.light;
  const double lit =
      std::fabs(x * light.east + y * light.north + z * light.up) /
      std::sqrt(x * x + y * y + z * z);
  const double shade = kAmbient + (1 - kAmbient) * lit;
  return {colour.red * shade, colour.green * shade, colour.blue * shade};
}

void DrawNet(const ControlPolyhedron& net, const Viewpoint& view,
             Canvas* canvas) {
  const auto at = [&](int i, int j) {
    const DepthPoint point =
        view.Project(net.points[static_cast<std::size_t>(j * net.columns + i)]);
    return PixelPoint{point.x / kSupersampling, point.y / kSupersampling};
  };
  for (int j = 0; j < net.rows; ++j) {
    for (int i = 0; i < net.columns; ++i) {
      const PixelPoint here = at(i, j);
      if (i + 1 < net.columns) {
        canvas->DrawLine(here, at(i + 1, j), kNetLineWidth, kNetLine);
      }
      if (j + 1 < net.rows) {
        canvas->DrawLine(here, at(i, j + 1), kNetLineWidth, kNetLine);
      }
      canvas->DrawLine({here.x - 1, here.y}, {here.x + 1, here.y}, kDotWidth,
                       kNetLine);
    }
  }
}

}  // namespace

Picture RenderSurface(const core::Mesh& mesh, const ControlPolyhedron& net,
                      const SurfaceViewOptions& options) {
  Viewpoint view(options);
  for (const core::Float3& point : mesh.positions) view.Include(point);
  for (const core::Float3& point : net.points) view.Include(point);
  view.Fit(options.width * kSupersampling,
           options.most_height * kSupersampling);

  std::vector<DepthPoint> seen;
  std::vector<Rgb> colours;
  for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
    seen.push_back(view.Project(mesh.positions[k]));
    colours.push_back(Shaded(ColourOf(mesh, k), mesh.normals[k], options));
  }
  DepthCanvas depth(options.width * kSupersampling, view.height());
  for (std::size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
    const std::size_t a = mesh.indices[k];
    const std::size_t b = mesh.indices[k + 1];
    const std::size_t c = mesh.indices[k + 2];
    depth.FillTriangle(
        seen[a], seen[b], seen[c], [&](double wa, double wb, double wc) {
          return Mixed(colours[a], wa, colours[b], wb, colours[c], wc);
        });
  }
  Canvas canvas = depth.Shrunk();
  DrawNet(net, view, &canvas);
  return canvas.picture();
}

}  // namespace terrane::client
