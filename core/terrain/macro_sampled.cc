#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/grid/cubic_weights.h"
#include "core/grid/raster_sampler.h"
#include "core/spline/basis.h"
#include "core/terrain/macro_part.h"

namespace terrane::core {
namespace {

// Bounds of sums of `heights` whose weights' sizes sum to `gain`, with room for
// rounding.
MacroShape::Bounds HullOf(const std::vector<double>& heights, double gain) {
  const auto [least, most] =
      std::minmax_element(heights.begin(), heights.end());
  const double centre = 0.5 * (*least + *most);
  const double half = 0.5 * (*most - *least) * gain +
                      1e-9 * std::max(std::fabs(*least), std::fabs(*most));
  return {centre - half, centre + half};
}

class ControlNetPart : public MacroShapePart {
 public:
  explicit ControlNetPart(const ControlNet& net)
      : net_(net),
        along_x_(Basis::Of(net.basis, net.columns, net.degree)),
        along_y_(net.rows == 1 ? Basis::Bernstein(1)
                               : Basis::Of(net.basis, net.rows, net.degree)) {}

  void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                double* out) const override {
    const std::size_t support = static_cast<std::size_t>(along_x_.support());
    std::vector<double> values(rect.columns() * support);
    std::vector<std::size_t> first(rect.columns());
    for (std::size_t i = 0; i < rect.columns(); ++i) {
      const double t = Parameter(grid.x[rect.column_begin + i], net_.minimum.x,
                                 net_.maximum.x);
      first[i] = static_cast<std::size_t>(
          along_x_.Values(t, std::span(values).subspan(i * support, support)));
    }
    std::array<double, Basis::kMaxCount> row;
    for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
      BlendRows(grid.y[j], row);
      for (std::size_t i = 0; i < rect.columns(); ++i) {
        const double* value = values.data() + i * support;
        double sum = 0;
        for (std::size_t k = 0; k < support; ++k) {
          sum += value[k] * row[first[i] + k];
        }
        *out++ = sum;
      }
    }
  }

  MacroShape::Bounds BoundsIn(const Box&) const override {
    return HullOf(net_.heights, along_x_.LargestAbsoluteSum() *
                                    along_y_.LargestAbsoluteSum());
  }

 private:
  static double Parameter(double at, double minimum, double maximum) {
    return (at - minimum) / (maximum - minimum);
  }

  // The control points of the curve along x at `y`.
  void BlendRows(double y, std::span<double> row) const {
    std::array<double, Basis::kMaxCount> values;
    const double t =
        net_.rows == 1 ? 0.0 : Parameter(y, net_.minimum.y, net_.maximum.y);
    const std::size_t first =
        static_cast<std::size_t>(along_y_.Values(t, values));
    const std::size_t columns = static_cast<std::size_t>(net_.columns);
    const std::size_t support = static_cast<std::size_t>(along_y_.support());
    for (std::size_t i = 0; i < columns; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < support; ++k) {
        sum += values[k] * net_.heights[(first + k) * columns + i];
      }
      row[i] = sum;
    }
  }

  ControlNet net_;
  Basis along_x_;
  Basis along_y_;
};

class ProfilePart : public MacroShapePart {
 public:
  explicit ProfilePart(const Profile& profile) : profile_(profile) {}

  void Evaluate(const SampleGrid& grid, const SampleRect& rect,
                double* out) const override {
    for (std::size_t i = 0; i < rect.columns(); ++i) {
      out[i] = HeightAt(grid.x[rect.column_begin + i]);
    }
    for (std::size_t j = 1; j < rect.rows(); ++j) {
      std::copy_n(out, rect.columns(), out + j * rect.columns());
    }
  }

  MacroShape::Bounds BoundsIn(const Box&) const override {
    return HullOf(profile_.heights,
                  profile_.interpolation == Interpolation::kCatmullRom
                      ? kCatmullRomGain
                      : 1.0);
  }

 private:
  // A place between two neighbouring vertices: t = 0 at `cell`, 1 at the next.
  struct Place {
    std::size_t cell;
    double t;
  };

  Place PlaceOf(double x) const {
    const std::size_t last_cell = profile_.heights.size() - 2;
    if (profile_.x.empty()) {
      const double position =
          std::clamp((x - profile_.first_x) / profile_.step_x, 0.0,
                     static_cast<double>(last_cell + 1));
      const std::size_t cell =
          std::min(static_cast<std::size_t>(position), last_cell);
      return {cell, position - static_cast<double>(cell)};
    }
    const auto above =
        std::upper_bound(profile_.x.begin() + 1, profile_.x.end() - 1, x);
    const std::size_t cell =
        static_cast<std::size_t>(above - profile_.x.begin()) - 1;
    const double t =
        (x - profile_.x[cell]) / (profile_.x[cell + 1] - profile_.x[cell]);
    return {cell, std::clamp(t, 0.0, 1.0)};
  }

  double HeightAt(double x) const {
    const Place place = PlaceOf(x);
    const std::vector<double>& heights = profile_.heights;
    if (profile_.interpolation != Interpolation::kCatmullRom) {
      return (1.0 - place.t) * heights[place.cell] +
             place.t * heights[place.cell + 1];
    }
    const std::size_t last = heights.size() - 1;
    const CubicWeights weights = CatmullRomWeights(place.t);
    // Beyond the ends the end values repeat.
    return weights.at[0] * heights[place.cell == 0 ? 0 : place.cell - 1] +
           weights.at[1] * heights[place.cell] +
           weights.at[2] * heights[place.cell + 1] +
           weights.at[3] * heights[std::min(place.cell + 2, last)];
  }

  Profile profile_;
};

SampleKernel KernelOf(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::kBilinear:
      return SampleKernel::kBilinear;
    case Interpolation::kCatmullRom:
      return SampleKernel::kCatmullRom;
    case Interpolation::kBSpline:
      break;
  }
  return SampleKernel::kBSpline;
}

// World coordinates in units of posts.
std::vector<double> Positions(std::span<const double> world, double origin,
                              double spacing) {
  std::vector<double> positions;
  positions.reserve(world.size());
  for (const double at : world) positions.push_back((at - origin) / spacing);
  return positions;
}

}  // namespace

RasterPart::RasterPart(const RasterShape& shape, const Frame& frame)
    : raster_(shape.raster),
      is_lattice_(shape.raster->frame == frame),
      sampler_(shape.raster->values, shape.raster->width, shape.raster->height,
               KernelOf(shape.interpolation)) {}

void RasterPart::EvaluateFloat(const SampleGrid& grid, const SampleRect& rect,
                               float* out, std::ptrdiff_t stride) const {
  const auto cut_x = [&](const std::vector<double>& axis) {
    return std::span(axis).subspan(rect.column_begin, rect.columns());
  };
  const auto cut_y = [&](const std::vector<double>& axis) {
    return std::span(axis).subspan(rect.row_begin, rect.rows());
  };
  if (is_lattice_) {
    sampler_.Sample(cut_x(grid.u), cut_y(grid.v), out, stride);
    return;
  }
  const Frame& frame = raster_->frame;
  sampler_.Sample(Positions(cut_x(grid.x), frame.origin_x, frame.spacing_x),
                  Positions(cut_y(grid.y), frame.origin_y, frame.spacing_y),
                  out, stride);
}

void RasterPart::Evaluate(const SampleGrid& grid, const SampleRect& rect,
                          double* out) const {
  std::vector<float> heights(rect.columns() * rect.rows());
  EvaluateFloat(grid, rect, heights.data(),
                static_cast<std::ptrdiff_t>(rect.columns()));
  std::copy(heights.begin(), heights.end(), out);
}

MacroShape::Bounds RasterPart::BoundsIn(const Box& box) const {
  const Frame& frame = raster_->frame;
  const auto [min_u, max_u] =
      std::minmax({(box.min_x - frame.origin_x) / frame.spacing_x,
                   (box.max_x - frame.origin_x) / frame.spacing_x});
  const auto [min_v, max_v] =
      std::minmax({(box.min_y - frame.origin_y) / frame.spacing_y,
                   (box.max_y - frame.origin_y) / frame.spacing_y});
  const RasterSampler::Bounds bounds =
      sampler_.BoundsIn(min_u, min_v, max_u, max_v);
  return {bounds.minimum, bounds.maximum};
}

std::unique_ptr<MacroShapePart> MakePart(const ControlNet& net) {
  return std::make_unique<ControlNetPart>(net);
}

std::unique_ptr<MacroShapePart> MakePart(const Profile& profile) {
  return std::make_unique<ProfilePart>(profile);
}

}  // namespace terrane::core
