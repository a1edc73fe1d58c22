#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>

#include "core/terrain/spec_checks.h"

namespace terrane::core {
namespace {

constexpr Range kSlopes{-1e6, 1e6};
// The largest control net has so many.
constexpr std::size_t kMostNetHeights =
    std::size_t{Basis::kMaxCount} * Basis::kMaxCount;

// Checks one shape; `path` is the part's.
class ShapeValidator {
 public:
  ShapeValidator(const Path& path, SpecChecks* checks)
      : path_(path), checks_(checks) {}

  void operator()(const std::monostate&) const {
    checks_->Violate(path_.Field("shape"),
                     "must be one of plane, cone, gaussian_hill, ridge, boss, "
                     "control_net, raster or profile, got none");
  }

  void operator()(const Plane& plane) const {
    const Path path = path_.Field("plane");
    checks_->Coordinates(path.Field("point"), plane.point);
    checks_->Number(path.Field("height"), plane.height, kHeights);
    checks_->Number(path.Field("slope_x"), plane.slope_x, kSlopes);
    checks_->Number(path.Field("slope_y"), plane.slope_y, kSlopes);
  }

  void operator()(const Cone& cone) const {
    const Path path = path_.Field("cone");
    checks_->Coordinates(path.Field("centre"), cone.centre);
    checks_->Number(path.Field("radius"), cone.radius, kLengths);
    checks_->Number(path.Field("height"), cone.height, kHeights);
  }

  void operator()(const GaussianHill& hill) const {
    const Path path = path_.Field("gaussian_hill");
    checks_->Coordinates(path.Field("centre"), hill.centre);
    checks_->Number(path.Field("sigma_x"), hill.sigma_x, kLengths);
    // 0 means the same as sigma_x.
    if (hill.sigma_y != 0) {
      checks_->Number(path.Field("sigma_y"), hill.sigma_y, kLengths);
    }
    checks_->Number(path.Field("height"), hill.height, kHeights);
  }

  void operator()(const Ridge& ridge) const {
    const Path path = path_.Field("ridge");
    checks_->Vertices(path.Field("crest"), ridge.crest, 2);
    checks_->Number(path.Field("half_width"), ridge.half_width, kLengths);
    checks_->Number(path.Field("height"), ridge.height, kHeights);
  }

  void operator()(const Boss& boss) const {
    const Path path = path_.Field("boss");
    checks_->Vertices(path.Field("outline"), boss.outline, 3);
    checks_->Number(path.Field("flank_width"), boss.flank_width,
                    Range{0, kLengths.high});
    checks_->Number(path.Field("height"), boss.height, kHeights);
  }

  void operator()(const ControlNet& net) const {
    const Path path = path_.Field("control_net");
    const bool plane = checks_->dimensions() == 2;
    const bool columns_good = checks_->Integer(
        path.Field("columns"), net.columns, 2, Basis::kMaxCount);
    const bool rows_good =
        checks_->Integer(path.Field("rows"), net.rows, plane ? 2 : 1,
                         plane ? Basis::kMaxCount : 1);
    CheckDegree(path, net, columns_good && rows_good);
    CheckNetHeights(path, net, columns_good && rows_good);
    const bool corners_good =
        checks_->Coordinates(path.Field("minimum"), net.minimum) &
        checks_->Coordinates(path.Field("maximum"), net.maximum);
    if (!corners_good) return;
    const Path maximum = path.Field("maximum");
    if (net.minimum.x == net.maximum.x) {
      checks_->Violate(maximum.Field("x"), "must differ from minimum.x, got " +
                                               NumberText(net.maximum.x));
    }
    if (plane && net.minimum.y == net.maximum.y) {
      checks_->Violate(maximum.Field("y"), "must differ from minimum.y, got " +
                                               NumberText(net.maximum.y));
    }
  }

  void operator()(const RasterShape& shape) const {
    const Path path = path_.Field("raster");
    if (checks_->dimensions() == 1) {
      checks_->Violate(path, "needs a recipe of 2 dimensions, got 1");
    }
    if (shape.raster == nullptr) {
      checks_->Violate(path.Field("raster_id"),
                       "must name an uploaded raster, got none");
      return;
    }
    const Raster& raster = *shape.raster;
    ValidateFrame(path.Field("frame"), raster.frame, checks_);
    if (raster.width < 2 || raster.height < 2) {
      checks_->Violate(path, "must have at least 2 x 2 posts, got " +
                                 std::to_string(raster.width) + " x " +
                                 std::to_string(raster.height));
      return;
    }
    // Divides rather than multiplies: the product could overflow.
    const std::size_t width = static_cast<std::size_t>(raster.width);
    const std::size_t height = static_cast<std::size_t>(raster.height);
    if (raster.values.size() % width != 0 ||
        raster.values.size() / width != height) {
      checks_->Violate(path, "must have width * height values, got " +
                                 std::to_string(raster.values.size()));
    }
  }

  void operator()(const Profile& profile) const {
    const Path path = path_.Field("profile");
    const std::size_t count = profile.heights.size();
    checks_->Count(path.Field("heights"), count, 2,
                   static_cast<std::size_t>(checks_->limits().max_vertices));
    const bool few = checks_->SpendVertices(path.Field("heights"), count);
    for (std::size_t i = 0; few && i < count; ++i) {
      checks_->Number(path.Element("heights", i), profile.heights[i], kHeights);
    }
    if (profile.x.empty()) {
      checks_->Number(path.Field("first_x"), profile.first_x, kCoordinates);
      checks_->Number(path.Field("step_x"), profile.step_x, kLengths);
    } else {
      CheckProfileVertices(path, profile);
    }
    if (profile.interpolation == Interpolation::kBSpline) {
      checks_->Violate(path.Field("interpolation"),
                       "must be BILINEAR or CATMULL_ROM, got BSPLINE");
    }
  }

 private:
  // `sides_good`: the net's columns and rows are in their ranges.
  void CheckDegree(const Path& path, const ControlNet& net,
                   bool sides_good) const {
    if (!HasDegree(net.basis)) return;
    const bool good = checks_->Integer(path.Field("degree"), net.degree, 1,
                                       Basis::kMaxBSplineDegree);
    if (!good || !sides_good) return;
    const int fewest = checks_->dimensions() == 2
                           ? std::min(net.columns, net.rows)
                           : net.columns;
    if (net.degree >= fewest) {
      checks_->Violate(path.Field("degree"),
                       "must be below the number of control points, " +
                           std::to_string(fewest) + ", got " +
                           std::to_string(net.degree));
    }
  }

  void CheckNetHeights(const Path& path, const ControlNet& net,
                       bool sides_good) const {
    if (sides_good) {
      const std::size_t expected = static_cast<std::size_t>(net.columns) *
                                   static_cast<std::size_t>(net.rows);
      if (net.heights.size() != expected) {
        checks_->Violate(
            path.Field("heights"),
            "must have rows * columns = " + std::to_string(expected) +
                " elements, got " + std::to_string(net.heights.size()));
      }
    }
    const std::size_t count = std::min(net.heights.size(), kMostNetHeights);
    for (std::size_t i = 0; i < count; ++i) {
      checks_->Number(path.Element("heights", i), net.heights[i], kHeights);
    }
  }

  void CheckProfileVertices(const Path& path, const Profile& profile) const {
    if (profile.x.size() != profile.heights.size()) {
      checks_->Violate(path.Field("x"),
                       "must have as many elements as heights, " +
                           std::to_string(profile.heights.size()) + ", got " +
                           std::to_string(profile.x.size()));
    }
    const std::size_t count =
        std::min(profile.x.size(),
                 static_cast<std::size_t>(checks_->limits().max_vertices));
    for (std::size_t i = 0; i < count; ++i) {
      const Path x = path.Element("x", i);
      if (!checks_->Number(x, profile.x[i], kCoordinates)) continue;
      if (i > 0 && profile.x[i] <= profile.x[i - 1]) {
        checks_->Violate(x, "must be above " + NumberText(profile.x[i - 1]) +
                                ", the one before, got " +
                                NumberText(profile.x[i]));
      }
    }
    if (profile.interpolation == Interpolation::kCatmullRom) {
      checks_->Violate(path.Field("interpolation"),
                       "CATMULL_ROM needs equally spaced samples (first_x and "
                       "step_x), got x");
    }
  }

  const Path& path_;
  SpecChecks* const checks_;
};

}  // namespace

void ValidateMacro(const Path& path, const MacroSpec& macro,
                   SpecChecks* checks) {
  checks->Number(path.Field("base"), macro.base, kHeights);
  if (!checks->Count(
          path.Field("parts"), macro.parts.size(), 0,
          static_cast<std::size_t>(checks->limits().max_macro_parts))) {
    return;
  }
  for (std::size_t i = 0; i < macro.parts.size(); ++i) {
    const Path part = path.Element("parts", i);
    std::visit(ShapeValidator(part, checks), macro.parts[i].shape);
  }
}

}  // namespace terrane::core
