// Surface: a fractal free-form surface made ready to generate, and the
// generation itself.
//
// A Surface is immutable and thread-safe; share it by shared_ptr<const
// Surface>. Samples lie on a grid over the parameter square, t along the
// columns, u along the rows; any window of it can be asked for on its own.
// Memory of a call: a few floats a column of its window.
//
// Determinism: a position is a pure function of (spec, grid, it, iu), a normal
// of those of five neighbours. Neither depends on the window it was asked in,
// the thread, the SIMD target, the build type, or what was generated before.
//
// Cost: independent samples cost the same anywhere. With carry-over a row is a
// recurrence from t = 0 (core/surface/carry_over.h): a window that begins at
// column x also pays for the x columns before it.
//
// Source: Mo, Tan & Zhang 2001 (eqs. 1-6), the training in closed form
// (core/surface/adaline.h).
#ifndef TERRANE_CORE_SURFACE_SURFACE_H_
#define TERRANE_CORE_SURFACE_SURFACE_H_

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/grid/lattice_window.h"
#include "core/surface/surface_model.h"
#include "core/surface/surface_spec.h"

namespace terrane::core {

// Most samples of a grid along an axis.
inline constexpr std::int64_t kMaxGridSide = std::int64_t{1} << 20;

// Samples [x, x + width) x [y, y + height) of a grid: x counts it, y counts iu.
struct SurfaceRequest {
  SurfaceGrid grid;
  Window window;
};

// Where generated columns go: row-major, t fastest, window.width *
// window.height entries each. Normals and texture coordinates may be empty:
// they are not made then.
struct SurfaceVertices {
  std::span<float> positions;  // x, y, z
  std::span<float> normals;    // x, y, z; unit vectors
  std::span<float> uvs;        // t, u
};

class Surface {
 public:
  // Validates the spec. Errors: INVALID_ARGUMENT with violations (field paths
  // relative to the recipe, such as "network.weights[0].i").
  static absl::StatusOr<std::shared_ptr<const Surface>> Create(
      SurfaceSpec spec);

  // The spec as it was given.
  const SurfaceSpec& spec() const { return model_.spec; }
  // It taken apart: unit direction, heights along it.
  const SurfaceModel& model() const { return model_; }

  // What is wrong with a request. Field names: "columns", "rows", "window.x",
  // "window.y", "window.width", "window.height".
  absl::Status CheckRequest(const SurfaceRequest& request) const;

  // Generates the fractal surface. Positions (and normals) of samples below the
  // hole level are NaN. CANCELLED when `stop` was asked to (polled at least
  // every millisecond of work), INVALID_ARGUMENT as CheckRequest.
  absl::Status Generate(const SurfaceRequest& request, std::stop_token stop,
                        const SurfaceVertices& out) const;

  // The regular surface (eq. 1) at the same samples: no networks, no holes.
  absl::Status GenerateRegular(const SurfaceRequest& request,
                               std::stop_token stop,
                               const SurfaceVertices& out) const;

  // The perturbed coordinate alone, which is z for the default direction; NaN
  // below the hole level.
  absl::Status GenerateHeights(const SurfaceRequest& request,
                               std::stop_token stop,
                               std::span<float> out) const;

  // Samples that generating the window takes: with carry-over those before it.
  std::int64_t GeneratedSamples(const SurfaceRequest& request) const;

 private:
  explicit Surface(const SurfaceSpec& valid) : model_(valid) {}

  SurfaceModel model_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_SURFACE_H_
