#include "core/terrain/macro_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "core/terrain/macro_part.h"

namespace terrane::core {
namespace {

// Samples that are evaluated together: their sums and one part's heights stay
// in the second-level cache.
constexpr std::size_t kBandSamples = 8192;

struct Part {
  MacroCombine combine;
  std::unique_ptr<MacroShapePart> shape;
};

// NaN, no data, wins over every height. Adding 0 turns -0 into 0, so that no
// sign of a zero depends on which parts were left out.
double Combined(MacroCombine combine, double below, double height) {
  const double value = height + 0.0;
  switch (combine) {
    case MacroCombine::kAdd:
      break;
    case MacroCombine::kMaximum:
      return value > below || std::isnan(value) ? value : below;
    case MacroCombine::kMinimum:
      return value < below || std::isnan(value) ? value : below;
  }
  return below + value;
}

std::unique_ptr<MacroShapePart> MakeShape(const MacroPart& part, int dimensions,
                                          const Frame& frame) {
  return std::visit(
      [&](const auto& shape) -> std::unique_ptr<MacroShapePart> {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, std::monostate>) {
          return nullptr;  // a valid spec has none
        } else if constexpr (std::is_same_v<Shape, RasterShape>) {
          return std::make_unique<RasterPart>(shape, frame);
        } else if constexpr (std::is_same_v<Shape, ControlNet> ||
                             std::is_same_v<Shape, Profile>) {
          return MakePart(shape);
        } else {
          return MakePart(shape, dimensions);
        }
      },
      part.shape);
}

}  // namespace

class MacroShape::Impl {
 public:
  Impl(const MacroSpec& spec, int dimensions, const Frame& frame)
      : base_(spec.base + 0.0) {
    parts_.reserve(spec.parts.size());
    for (const MacroPart& part : spec.parts) {
      parts_.push_back({part.combine, MakeShape(part, dimensions, frame)});
    }
    if (spec.base == 0 && parts_.size() == 1 &&
        parts_.front().combine == MacroCombine::kAdd) {
      only_raster_ =
          dynamic_cast<const RasterPart*>(parts_.front().shape.get());
    }
  }

  std::optional<float> constant() const {
    if (!parts_.empty()) return std::nullopt;
    return static_cast<float>(base_);
  }

  void Evaluate(const SampleGrid& grid, float* out, std::ptrdiff_t stride,
                const std::stop_token& stop) const {
    const SampleRect all = AllSamples(grid);
    if (all.empty()) return;
    if (only_raster_ != nullptr) {
      only_raster_->EvaluateFloat(grid, all, out, stride);
      return;
    }
    std::vector<SampleRect> supports;
    supports.reserve(parts_.size());
    for (const Part& part : parts_) {
      supports.push_back(SamplesIn(grid, part.shape->Support()));
    }
    const std::size_t band_rows =
        std::clamp<std::size_t>(kBandSamples / all.columns(), 1, all.rows());
    std::vector<double> sums(band_rows * all.columns());
    std::vector<double> heights(sums.size());
    for (std::size_t row = 0; row < all.rows(); row += band_rows) {
      SampleRect band = all;
      band.row_begin = row;
      band.row_end = std::min(row + band_rows, all.rows());
      EvaluateBand(grid, band, supports, stop, sums.data(), heights.data());
      for (std::size_t j = 0; j < band.rows(); ++j) {
        std::transform(
            sums.data() + j * all.columns(),
            sums.data() + (j + 1) * all.columns(),
            out + static_cast<std::ptrdiff_t>(row + j) * stride,
            [](double height) { return static_cast<float>(height); });
      }
    }
  }

  Bounds BoundsIn(const Box& box) const {
    Bounds bounds{base_, base_};
    for (const Part& part : parts_) {
      const Bounds heights = part.shape->BoundsIn(box);
      bounds = {Combined(part.combine, bounds.minimum, heights.minimum),
                Combined(part.combine, bounds.maximum, heights.maximum)};
    }
    // Room for the rounding of sums and of the float at the end.
    const double slack = 0x1p-22 * std::max(std::fabs(bounds.minimum),
                                            std::fabs(bounds.maximum));
    return {bounds.minimum - slack, bounds.maximum + slack};
  }

 private:
  void EvaluateBand(const SampleGrid& grid, const SampleRect& band,
                    const std::vector<SampleRect>& supports,
                    const std::stop_token& stop, double* sums,
                    double* heights) const {
    std::fill_n(sums, band.columns() * band.rows(), base_);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if (stop.stop_requested()) return;
      const SampleRect rect = Intersection(supports[k], band);
      if (!rect.empty()) parts_[k].shape->Evaluate(grid, rect, heights);
      if (parts_[k].combine == MacroCombine::kAdd) {
        if (!rect.empty()) Add(band, rect, heights, sums);
      } else {
        Limit(parts_[k].combine, band, rect, heights, sums);
      }
    }
  }

  // Adds the heights of `rect`; the shape is 0 in the rest of the band.
  static void Add(const SampleRect& band, const SampleRect& rect,
                  const double* heights, double* sums) {
    for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
      double* row = sums + (j - band.row_begin) * band.columns();
      for (std::size_t i = rect.column_begin; i < rect.column_end; ++i) {
        row[i] = Combined(MacroCombine::kAdd, row[i], *heights++);
      }
    }
  }

  // Takes the maximum or minimum, with 0 in the rest of the band.
  static void Limit(MacroCombine combine, const SampleRect& band,
                    const SampleRect& rect, const double* heights,
                    double* sums) {
    for (std::size_t j = band.row_begin; j < band.row_end; ++j) {
      const bool row_in = j >= rect.row_begin && j < rect.row_end;
      for (std::size_t i = 0; i < band.columns(); ++i) {
        const bool in = row_in && i >= rect.column_begin && i < rect.column_end;
        *sums = Combined(combine, *sums, in ? *heights++ : 0.0);
        ++sums;
      }
    }
  }

  double base_;
  std::vector<Part> parts_;
  // The part, when d is this raster and nothing else: its bits pass unchanged.
  const RasterPart* only_raster_ = nullptr;
};

MacroShape::MacroShape(const MacroSpec& spec, int dimensions,
                       const Frame& frame)
    : impl_(std::make_unique<Impl>(spec, dimensions, frame)) {}
MacroShape::~MacroShape() = default;
MacroShape::MacroShape(MacroShape&&) noexcept = default;
MacroShape& MacroShape::operator=(MacroShape&&) noexcept = default;

std::optional<float> MacroShape::constant() const { return impl_->constant(); }

void MacroShape::Evaluate(const SampleGrid& grid, float* out,
                          std::ptrdiff_t stride,
                          const std::stop_token& stop) const {
  impl_->Evaluate(grid, out, stride, stop);
}

MacroShape::Bounds MacroShape::BoundsIn(double min_x, double min_y,
                                        double max_x, double max_y) const {
  return impl_->BoundsIn({min_x, min_y, max_x, max_y});
}

}  // namespace terrane::core
