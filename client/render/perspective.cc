#include "client/render/perspective.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "client/render/depth_canvas.h"

namespace terrane::client {
namespace {

constexpr Rgb kWall{0.62, 0.57, 0.52};
constexpr Rgb kWaterWall{0.36, 0.53, 0.70};

// Posts a side that are drawn; more would be smaller than a pixel.
constexpr std::int64_t kMaxPosts = 1400;
constexpr double kMarginShare = 0.03;
// The block's floor lies this share of the relief below the lowest height.
constexpr double kFloorShare = 0.25;
constexpr double kReliefShare = 1.0 / 9;

constexpr double kDry = -1;

// A corner of a triangle: where on the canvas, how far away, what colour.
struct Corner : DepthPoint {
  Rgb colour;
  // How deep the ground lies under water; drawn as water where above 0.
  double depth = kDry;
};

// A canvas of land and water.
class BlockCanvas {
 public:
  // `range` is that of the land, which the water's colours depend on.
  BlockCanvas(int width, int height, const TintRange& range)
      : canvas_(width, height), range_(range) {}

  void FillTriangle(const Corner& a, const Corner& b, const Corner& c) {
    canvas_.FillTriangle(a, b, c, [&](double wa, double wb, double wc) {
      // The shore lies where the depth is 0, inside a triangle.
      const double depth = wa * a.depth + wb * b.depth + wc * c.depth;
      return depth > 0 ? WaterTint(depth, range_)
                       : Mixed(a.colour, wa, b.colour, wb, c.colour, wc);
    });
  }

  void FillQuad(const Corner& a, const Corner& b, const Corner& c,
                const Corner& d) {
    FillTriangle(a, b, c);
    FillTriangle(b, c, d);
  }

  Picture Shrunk() const { return canvas_.Shrunk().picture(); }

 private:
  DepthCanvas canvas_;
  TintRange range_;
};

// The posts that are drawn, with their colours.
struct Block {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  double step_x = 1;  // ground distance of drawn posts
  double step_y = 1;
  std::vector<double> ground;   // heights of the land, also under water
  std::vector<double> surface;  // the same, but water where it is higher
  std::vector<Rgb> colours;
  TintRange range;  // of the land above the water
  double minimum = 0;
  double maximum = 0;
  double exaggeration = 1;

  std::size_t At(std::int64_t i, std::int64_t j) const {
    return static_cast<std::size_t>(j * columns + i);
  }
  double relief() const { return maximum - minimum; }
  double longer_side() const {
    return std::max(step_x * static_cast<double>(columns - 1),
                    step_y * static_cast<double>(rows - 1));
  }
};

// Every step-th post; a thinned field is shaded as it is drawn.
std::vector<float> Thinned(const core::HeightView& heights, std::int64_t step,
                           Block* block) {
  block->columns = (heights.width - 1) / step + 1;
  block->rows = (heights.height - 1) / step + 1;
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(block->columns * block->rows));
  for (std::int64_t j = 0; j < block->rows; ++j) {
    for (std::int64_t i = 0; i < block->columns; ++i) {
      values.push_back(heights.At(i * step, j * step));
    }
  }
  return values;
}

Block MakeBlock(const core::HeightView& heights, const core::GroundScale& scale,
                const PerspectiveOptions& options) {
  const std::int64_t step =
      (std::max(heights.width, heights.height) + kMaxPosts - 1) / kMaxPosts;
  Block block;
  const std::vector<float> values = Thinned(heights, step, &block);
  const core::GroundSpacing& spacing = scale.Row(heights.height / 2);
  block.step_x = spacing.x * static_cast<double>(step);
  block.step_y = spacing.y * static_cast<double>(step);
  const core::HeightView view{block.columns, block.rows, values};
  block.range = TintRangeOf(view, options.water_level);
  const TintRange whole = TintRangeOf(view, std::nullopt);
  block.minimum = whole.minimum;
  block.maximum = std::max(whole.maximum, block.range.maximum);

  std::vector<float> shade(values.size());
  block.exaggeration = options.exaggeration.value_or(
      block.relief() > 0 ? kReliefShare * block.longer_side() / block.relief()
                         : 1);
  // The light sees the same relief as the viewer.
  core::Hillshade(
      view, core::GroundScale(core::GroundSpacing{block.step_x, block.step_y}),
      options.light, block.exaggeration, shade);
  for (std::size_t at = 0; at < values.size(); ++at) {
    const double height = values[at];
    block.ground.push_back(height);
    block.surface.push_back(options.water_level.has_value()
                                ? std::isnan(height)
                                      ? height
                                      : std::max(height, *options.water_level)
                                : height);
    block.colours.push_back(
        Lit(LandTint(height, block.range), shade[at], options.light.up));
  }
  return block;
}

// Ground to canvas by a parallel projection; fitted to the canvas's width.
class View {
 public:
  View(const Block& block, const PerspectiveOptions& options) : block_(block) {
    const double turn = options.turn_deg * std::numbers::pi / 180;
    const double tilt = options.tilt_deg * std::numbers::pi / 180;
    turn_cos_ = std::cos(turn);
    turn_sin_ = std::sin(turn);
    tilt_cos_ = std::cos(tilt);
    tilt_sin_ = std::sin(tilt);
    floor_ = block.minimum -
             kFloorShare * std::max(block.relief(), 1e-9 * block.longer_side());
    Fit(options.width * kSupersampling);
  }

  double floor() const { return floor_; }
  int canvas_height() const { return canvas_height_; }

  Corner Project(std::int64_t i, std::int64_t j, double height,
                 const Rgb& colour) const {
    const Corner raw = Rotated(i, j, height);
    return {{(raw.x - left_) * pixels_ + margin_,
             (raw.y - top_) * pixels_ + margin_, raw.distance},
            colour};
  }

 private:
  // y grows downwards, distance away from the viewer.
  Corner Rotated(std::int64_t i, std::int64_t j, double height) const {
    const double east = block_.step_x * static_cast<double>(i);
    const double south = block_.step_y * static_cast<double>(j);
    const double up = block_.exaggeration * (height - block_.minimum);
    const double right = east * turn_cos_ + south * turn_sin_;
    const double near = south * turn_cos_ - east * turn_sin_;
    return {{right, near * tilt_sin_ - up * tilt_cos_,
             -near * tilt_cos_ - up * tilt_sin_},
            {}};
  }

  void Fit(int canvas_width) {
    double right = -std::numeric_limits<double>::infinity();
    double bottom = right;
    left_ = top_ = -right;
    const auto include = [&](const Corner& corner) {
      left_ = std::min(left_, corner.x);
      right = std::max(right, corner.x);
      top_ = std::min(top_, corner.y);
      bottom = std::max(bottom, corner.y);
    };
    for (const std::int64_t j : {std::int64_t{0}, block_.rows - 1}) {
      for (const std::int64_t i : {std::int64_t{0}, block_.columns - 1}) {
        include(Rotated(i, j, floor_));
      }
    }
    for (std::int64_t j = 0; j < block_.rows; ++j) {
      for (std::int64_t i = 0; i < block_.columns; ++i) {
        const double height = block_.surface[block_.At(i, j)];
        if (!std::isnan(height)) include(Rotated(i, j, height));
      }
    }
    margin_ = kMarginShare * canvas_width;
    const double extent = std::max(right - left_, 1e-9);
    pixels_ = (canvas_width - 2 * margin_) / extent;
    canvas_height_ =
        static_cast<int>(std::ceil((bottom - top_) * pixels_ + 2 * margin_)) /
        kSupersampling * kSupersampling;
  }

  const Block& block_;
  double turn_cos_, turn_sin_, tilt_cos_, tilt_sin_;
  double floor_;
  double left_, top_;
  double pixels_ = 1;
  double margin_ = 0;
  int canvas_height_ = 0;
};

void DrawTop(const Block& block, const View& view,
             std::optional<double> water_level, BlockCanvas* canvas) {
  const auto corner = [&](std::int64_t i, std::int64_t j) {
    const std::size_t at = block.At(i, j);
    Corner result = view.Project(i, j, block.surface[at], block.colours[at]);
    if (water_level.has_value()) {
      result.depth = *water_level - block.ground[at];
    }
    return result;
  };
  for (std::int64_t j = 0; j + 1 < block.rows; ++j) {
    for (std::int64_t i = 0; i + 1 < block.columns; ++i) {
      const std::array<Corner, 4> corners = {corner(i, j), corner(i + 1, j),
                                             corner(i, j + 1),
                                             corner(i + 1, j + 1)};
      // A missing post leaves a hole.
      const bool whole =
          std::none_of(corners.begin(), corners.end(),
                       [](const Corner& one) { return std::isnan(one.y); });
      if (whole) {
        canvas->FillQuad(corners[0], corners[1], corners[2], corners[3]);
      }
    }
  }
}

// The wall under the edge between two neighbouring posts, `lit` brighter or
// darker by its side.
void DrawWall(const Block& block, const View& view, std::int64_t i0,
              std::int64_t j0, std::int64_t i1, std::int64_t j1, double lit,
              BlockCanvas* canvas) {
  const std::size_t at0 = block.At(i0, j0);
  const std::size_t at1 = block.At(i1, j1);
  if (std::isnan(block.ground[at0]) || std::isnan(block.ground[at1])) return;
  const auto draw = [&](const std::vector<double>& top, double foot0,
                        double foot1, const Rgb& colour, const Rgb& foot) {
    canvas->FillQuad(view.Project(i0, j0, top[at0], colour),
                     view.Project(i1, j1, top[at1], colour),
                     view.Project(i0, j0, foot0, foot),
                     view.Project(i1, j1, foot1, foot));
  };
  constexpr Rgb kDark{0, 0, 0};
  const Rgb earth = Mix(kDark, kWall, lit);
  const Rgb water = Mix(kDark, kWaterWall, lit);
  draw(block.ground, view.floor(), view.floor(), earth, Mix(kDark, earth, 0.8));
  draw(block.surface, block.ground[at0], block.ground[at1], water, water);
}

void DrawWalls(const Block& block, const View& view, BlockCanvas* canvas) {
  const std::int64_t last_row = block.rows - 1;
  const std::int64_t last_column = block.columns - 1;
  for (std::int64_t i = 0; i < last_column; ++i) {
    DrawWall(block, view, i, 0, i + 1, 0, 0.9, canvas);
    DrawWall(block, view, i, last_row, i + 1, last_row, 0.9, canvas);
  }
  for (std::int64_t j = 0; j < last_row; ++j) {
    DrawWall(block, view, 0, j, 0, j + 1, 1.0, canvas);
    DrawWall(block, view, last_column, j, last_column, j + 1, 0.72, canvas);
  }
}

}  // namespace

PerspectivePicture RenderPerspective(const core::HeightView& heights,
                                     const core::GroundScale& scale,
                                     const PerspectiveOptions& options) {
  const Block block = MakeBlock(heights, scale, options);
  const View view(block, options);
  BlockCanvas canvas(options.width * kSupersampling, view.canvas_height(),
                     block.range);
  DrawTop(block, view, options.water_level, &canvas);
  DrawWalls(block, view, &canvas);
  return {canvas.Shrunk(), block.exaggeration};
}

}  // namespace terrane::client
