// HeightField: a surface that is a graph over (x, y), resampled on a regular
// grid.
//
// The raster spans the surface's rectangle of x and y with as many samples
// along x and y as the grid over (t, u) has along t and u: sample (0, 0) lies
// at the smallest x and y. A height is that of the mesh of the grid, bilinear
// in the cell that the sample falls into; a sample on a vertex has its height
// exactly. Where a vertex that counts was left out (hole level) it is NaN.
//
// Immutable and thread-safe. Determinism: a height is a function of (spec,
// grid, ix, iy). Cost: that of the (t, u) samples around the window; memory is
// bounded whatever the window.
#ifndef TERRANE_CORE_SURFACE_HEIGHT_FIELD_H_
#define TERRANE_CORE_SURFACE_HEIGHT_FIELD_H_

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/grid/lattice_window.h"
#include "core/surface/surface.h"

namespace terrane::core {

class HeightField {
 public:
  // Errors: INVALID_ARGUMENT with violations when the surface is no graph over
  // (x, y), as ValidateHeightField.
  static absl::StatusOr<HeightField> Create(
      std::shared_ptr<const Surface> surface);

  // Place of sample (0, 0) and the distance of neighbouring samples.
  Frame FrameOf(const SurfaceGrid& grid) const;

  // Writes window.width * window.height heights, row-major. The window counts
  // samples of the raster. Errors: as Surface::Generate.
  absl::Status Generate(const SurfaceRequest& request, std::stop_token stop,
                        std::span<float> out) const;

 private:
  // Where a raster column or row lies among the samples of the grid.
  struct Place {
    std::int64_t cell = 0;
    double share = 0;  // of the sample behind the cell
  };
  // One axis: the curve that the net's coordinate follows along it.
  struct Axis {
    Basis basis;
    std::vector<double> controls;

    double At(std::int64_t index, std::int64_t count) const;
    std::vector<Place> Places(std::int64_t count, std::int64_t first,
                              std::int64_t places) const;
  };
  class Resampler;

  HeightField(std::shared_ptr<const Surface> surface, Axis along_x,
              Axis along_y)
      : surface_(std::move(surface)),
        along_x_(std::move(along_x)),
        along_y_(std::move(along_y)) {}

  std::shared_ptr<const Surface> surface_;
  Axis along_x_;
  Axis along_y_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_HEIGHT_FIELD_H_
