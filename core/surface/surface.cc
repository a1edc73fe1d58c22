#include "core/surface/surface.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/field_checks.h"
#include "core/base/violations.h"
#include "core/grid/grid_view.h"
#include "core/mesh/grid_normals.h"
#include "core/mesh/mesh.h"
#include "core/surface/surface_rows.h"
#include "core/surface/validate_surface.h"

namespace terrane::core {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

void CheckAxis(const Path& size_path, std::int64_t size, const Path& begin_path,
               std::int64_t begin, const Path& count_path, std::int64_t count,
               FieldChecks* checks) {
  if (!checks->Integer(size_path, size, 2, kMaxGridSide)) return;
  if (!checks->Integer(begin_path, begin, 0, size - 1)) return;
  checks->Integer(count_path, count, 1, size - begin);
}

// Makes the vertices of one window. Three rows of positions are kept at a time:
// a normal needs the rows around its own, and the columns around the window.
class VertexMaker {
 public:
  VertexMaker(const SurfaceModel& model, const SurfaceRequest& request,
              bool fractal, std::stop_token stop, const SurfaceVertices& out)
      : model_(model),
        grid_(request.grid),
        window_(request.window),
        fractal_(fractal),
        stop_(std::move(stop)),
        out_(out),
        margin_left_(!out.normals.empty() && window_.x > 0 ? 1 : 0),
        margin_right_(!out.normals.empty() &&
                              window_.x + window_.width < grid_.columns
                          ? 1
                          : 0),
        rows_(&model, grid_, window_.x - margin_left_,
              window_.width + margin_left_ + margin_right_) {
    for (Row& row : ring_) {
      for (Column* column : {&row.x, &row.y, &row.z, &row.height}) {
        column->first = column->buffer.Shape(window_.width + 2, 1).Row(0) + 1;
      }
    }
  }

  absl::Status Run() {
    const bool with_normals = !out_.normals.empty();
    std::int64_t next =
        with_normals ? std::max<std::int64_t>(window_.y - 1, 0) : window_.y;
    for (std::int64_t iu = window_.y; iu < window_.y + window_.height; ++iu) {
      const std::int64_t last =
          with_normals ? std::min(iu + 1, grid_.rows - 1) : iu;
      for (; next <= last; ++next) {
        if (!Make(next)) return absl::CancelledError("generation stopped");
      }
      Write(iu);
    }
    return absl::OkStatus();
  }

 private:
  // A row of floats; first[-1] and first[window.width] stand beside the window.
  struct Column {
    GridBuffer buffer;
    float* first = nullptr;
  };
  struct Row {
    Column x, y, z, height;
  };

  Row& RingRow(std::int64_t iu) {
    return ring_[static_cast<std::size_t>(iu % 3)];
  }

  bool Make(std::int64_t iu) {
    Row& row = RingRow(iu);
    rows_.SetRow(iu);
    float* const heights = row.height.first - margin_left_;
    if (!fractal_) {
      rows_.RegularHeights(heights);
      if (stop_.stop_requested()) return false;
    } else if (!rows_.Heights(stop_, heights)) {
      return false;
    }
    rows_.Positions(heights, row.x.first - margin_left_,
                    row.y.first - margin_left_, row.z.first - margin_left_);
    // The edge of the grid stands in for what lies beyond it.
    for (const Column* column : {&row.x, &row.y, &row.z}) {
      if (margin_left_ == 0) column->first[-1] = column->first[0];
      if (margin_right_ == 0) {
        column->first[window_.width] = column->first[window_.width - 1];
      }
    }
    return true;
  }

  static VertexRow View(const Row& row) {
    return {row.x.first, row.y.first, row.z.first};
  }

  void Write(std::int64_t iu) {
    const auto width = static_cast<std::size_t>(window_.width);
    const std::size_t begin = static_cast<std::size_t>(iu - window_.y) * width;
    const int count = static_cast<int>(window_.width);
    const Row& row = RingRow(iu);
    InterleaveVertices(View(row), count, out_.positions.data() + 3 * begin);
    if (!out_.normals.empty()) {
      const Point3& up = model_.direction;
      GridNormals(View(RingRow(std::max<std::int64_t>(iu - 1, 0))), View(row),
                  View(RingRow(std::min(iu + 1, grid_.rows - 1))),
                  {static_cast<float>(up.x), static_cast<float>(up.y),
                   static_cast<float>(up.z)},
                  count, out_.normals.data() + 3 * begin);
    }
    if (!out_.uvs.empty()) WriteUvs(iu, out_.uvs.data() + 2 * begin);
    if (fractal_ && model_.spec.hole_level.has_value()) {
      LeaveOut(row.height.first, begin);
    }
  }

  void WriteUvs(std::int64_t iu, float* uvs) const {
    const auto u = static_cast<float>(GridParameter(iu, grid_.rows));
    for (std::int64_t c = 0; c < window_.width; ++c) {
      *uvs++ = static_cast<float>(GridParameter(window_.x + c, grid_.columns));
      *uvs++ = u;
    }
  }

  void LeaveOut(const float* heights, std::size_t begin) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(window_.width); ++c) {
      if (heights[c] >= *model_.spec.hole_level) continue;
      std::fill_n(out_.positions.data() + 3 * (begin + c), 3, kNoData);
      if (!out_.normals.empty()) {
        std::fill_n(out_.normals.data() + 3 * (begin + c), 3, kNoData);
      }
    }
  }

  const SurfaceModel& model_;
  const SurfaceGrid grid_;
  const Window window_;
  const bool fractal_;
  const std::stop_token stop_;
  const SurfaceVertices out_;
  const std::int64_t margin_left_;
  const std::int64_t margin_right_;
  SurfaceRows rows_;
  Row ring_[3];
};

}  // namespace

absl::StatusOr<std::shared_ptr<const Surface>> Surface::Create(
    SurfaceSpec spec) {
  Violations violations;
  ValidateSurface(spec, "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  return std::shared_ptr<const Surface>(new Surface(spec));
}

absl::Status Surface::CheckRequest(const SurfaceRequest& request) const {
  const std::string prefix;
  const Path root(&prefix);
  const Path window = root.Field("window");
  Violations violations;
  FieldChecks checks(&violations);
  CheckAxis(root.Field("columns"), request.grid.columns, window.Field("x"),
            request.window.x, window.Field("width"), request.window.width,
            &checks);
  CheckAxis(root.Field("rows"), request.grid.rows, window.Field("y"),
            request.window.y, window.Field("height"), request.window.height,
            &checks);
  return violations.ToStatus();
}

absl::Status Surface::Generate(const SurfaceRequest& request,
                               std::stop_token stop,
                               const SurfaceVertices& out) const {
  const absl::Status checked = CheckRequest(request);
  if (!checked.ok()) return checked;
  return VertexMaker(model_, request, true, std::move(stop), out).Run();
}

absl::Status Surface::GenerateRegular(const SurfaceRequest& request,
                                      std::stop_token stop,
                                      const SurfaceVertices& out) const {
  const absl::Status checked = CheckRequest(request);
  if (!checked.ok()) return checked;
  return VertexMaker(model_, request, false, std::move(stop), out).Run();
}

absl::Status Surface::GenerateHeights(const SurfaceRequest& request,
                                      std::stop_token stop,
                                      std::span<float> out) const {
  const absl::Status checked = CheckRequest(request);
  if (!checked.ok()) return checked;
  const Window& window = request.window;
  SurfaceRows rows(&model_, request.grid, window.x, window.width);
  GridBuffer buffer;
  float* const heights = buffer.Shape(window.width, 1).Row(0);
  for (std::int64_t j = 0; j < window.height; ++j) {
    rows.SetRow(window.y + j);
    if (!rows.Heights(stop, heights)) {
      return absl::CancelledError("generation stopped");
    }
    float* const row = out.data() + j * window.width;
    for (std::int64_t c = 0; c < window.width; ++c) {
      row[c] = model_.spec.hole_level.has_value() &&
                       heights[c] < *model_.spec.hole_level
                   ? kNoData
                   : heights[c];
    }
  }
  return absl::OkStatus();
}

std::int64_t Surface::GeneratedSamples(const SurfaceRequest& request) const {
  const Window& window = request.window;
  const std::int64_t columns =
      model_.spec.carry_over ? window.x + window.width : window.width;
  return columns * window.height;
}

}  // namespace terrane::core
