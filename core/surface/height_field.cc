#include "core/surface/height_field.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "core/base/violations.h"
#include "core/surface/validate_surface.h"

namespace terrane::core {
namespace {

// Samples of the grid that are in memory at a time.
constexpr std::int64_t kMostSamples = std::int64_t{1} << 18;
// Closer than this share of a cell counts as on the vertex.
constexpr double kOnVertex = 1e-9;

}  // namespace

double HeightField::Axis::At(std::int64_t index, std::int64_t count) const {
  std::array<double, Basis::kMaxCount> values;
  const int first = basis.Values(GridParameter(index, count), values);
  double sum = 0;
  for (int k = 0; k < basis.support(); ++k) {
    sum += values[static_cast<std::size_t>(k)] *
           controls[static_cast<std::size_t>(first + k)];
  }
  return sum;
}

std::vector<HeightField::Place> HeightField::Axis::Places(
    std::int64_t count, std::int64_t first, std::int64_t places) const {
  const double low = At(0, count);
  const double step =
      (At(count - 1, count) - low) / static_cast<double>(count - 1);
  std::vector<Place> result;
  for (std::int64_t k = first; k < first + places; ++k) {
    const double at = low + static_cast<double>(k) * step;
    // The last cell that begins at or before `at`; the curve rises.
    std::int64_t cell = 0;
    std::int64_t behind = count - 1;
    while (behind - cell > 1) {
      const std::int64_t middle = cell + (behind - cell) / 2;
      (At(middle, count) <= at ? cell : behind) = middle;
    }
    const double begin = At(cell, count);
    const double share = (at - begin) / (At(cell + 1, count) - begin);
    if (share < kOnVertex) {
      result.push_back({cell, 0});
    } else {
      result.push_back({cell, share > 1 - kOnVertex ? 1 : share});
    }
  }
  return result;
}

// One window being resampled, block by block.
class HeightField::Resampler {
 public:
  Resampler(const HeightField& field, const SurfaceRequest& request,
            std::stop_token stop, std::span<float> out)
      : surface_(*field.surface_),
        grid_(request.grid),
        width_(static_cast<std::size_t>(request.window.width)),
        stop_(std::move(stop)),
        out_(out),
        columns_(field.along_x_.Places(grid_.columns, request.window.x,
                                       request.window.width)),
        rows_(field.along_y_.Places(grid_.rows, request.window.y,
                                    request.window.height)) {}

  absl::Status Run() { return Resample({0, columns_.size(), 0, rows_.size()}); }

 private:
  struct Block {
    std::size_t column_begin;
    std::size_t column_end;
    std::size_t row_begin;
    std::size_t row_end;
  };

  // Cuts the block in halves until the samples around it fit.
  absl::Status Resample(const Block& block) {
    const Window box = Around(block);
    const std::size_t columns = block.column_end - block.column_begin;
    const std::size_t rows = block.row_end - block.row_begin;
    if (box.width * box.height <= kMostSamples || columns * rows == 1) {
      return Fill(block, box);
    }
    Block low = block;
    Block high = block;
    if (columns >= rows) {
      low.column_end = high.column_begin = block.column_begin + columns / 2;
    } else {
      low.row_end = high.row_begin = block.row_begin + rows / 2;
    }
    const absl::Status status = Resample(low);
    return status.ok() ? Resample(high) : status;
  }

  Window Around(const Block& block) const {
    const std::int64_t x = columns_[block.column_begin].cell;
    const std::int64_t y = rows_[block.row_begin].cell;
    return {x, y, columns_[block.column_end - 1].cell + 2 - x,
            rows_[block.row_end - 1].cell + 2 - y};
  }

  absl::Status Fill(const Block& block, const Window& box) {
    heights_.resize(static_cast<std::size_t>(box.width * box.height));
    const absl::Status status =
        surface_.GenerateHeights({grid_, box}, stop_, heights_);
    if (!status.ok()) return status;
    for (std::size_t j = block.row_begin; j < block.row_end; ++j) {
      const float* const row =
          heights_.data() + (rows_[j].cell - box.y) * box.width;
      for (std::size_t i = block.column_begin; i < block.column_end; ++i) {
        const float* const corner = row + (columns_[i].cell - box.x);
        const double low = Mix(corner[0], corner[1], columns_[i].share);
        const double high =
            Mix(corner[box.width], corner[box.width + 1], columns_[i].share);
        out_[j * width_ + i] =
            static_cast<float>(Mix(low, high, rows_[j].share));
      }
    }
    return absl::OkStatus();
  }

  // A value that has no share does not count, not even when it is NaN.
  static double Mix(double first, double second, double share) {
    if (share == 0) return first;
    if (share == 1) return second;
    return first + (second - first) * share;
  }

  const Surface& surface_;
  const SurfaceGrid grid_;
  const std::size_t width_;
  const std::stop_token stop_;
  const std::span<float> out_;
  const std::vector<Place> columns_;
  const std::vector<Place> rows_;
  std::vector<float> heights_;
};

absl::StatusOr<HeightField> HeightField::Create(
    std::shared_ptr<const Surface> surface) {
  Violations violations;
  ValidateHeightField(surface->spec(), "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  const PointNet& net = surface->spec().net;
  Axis along_x = {surface->model().along_t, {}};
  Axis along_y = {surface->model().along_u, {}};
  for (int i = 0; i < net.columns; ++i) {
    along_x.controls.push_back(net.At(i, 0).x);
  }
  for (int j = 0; j < net.rows; ++j) {
    along_y.controls.push_back(net.At(0, j).y);
  }
  return HeightField(std::move(surface), std::move(along_x),
                     std::move(along_y));
}

Frame HeightField::FrameOf(const SurfaceGrid& grid) const {
  const auto step = [](const Axis& axis, std::int64_t count) {
    return (axis.At(count - 1, count) - axis.At(0, count)) /
           static_cast<double>(count - 1);
  };
  return {along_x_.At(0, grid.columns), along_y_.At(0, grid.rows),
          step(along_x_, grid.columns), step(along_y_, grid.rows)};
}

absl::Status HeightField::Generate(const SurfaceRequest& request,
                                   std::stop_token stop,
                                   std::span<float> out) const {
  const absl::Status checked = surface_->CheckRequest(request);
  if (!checked.ok()) return checked;
  return Resampler(*this, request, std::move(stop), out).Run();
}

}  // namespace terrane::core
