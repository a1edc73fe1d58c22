// Terrain: a spec made ready to generate from, and the generation itself.
//
// A Terrain is immutable and thread-safe; share it by shared_ptr<const
// Terrain>. Generating needs a TileScratch, working memory that one thread at a
// time uses and that may be reused for any number of tiles of any terrain.
//
// Determinism: a height is a pure function of (resolved spec, level, sampling,
// sample index). It does not depend on the window it was asked in, the thread,
// the SIMD target, the build type, or what was generated before.
//
// Source: Tan & Chen 2003 (eqs. 5-15); the chain is
// P_fbm (fractal_lattice.h) -> mapping (eq. 10 or LINEAR) -> + d(p).
#ifndef TERRANE_CORE_TERRAIN_TERRAIN_H_
#define TERRANE_CORE_TERRAIN_TERRAIN_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/grid/lattice_window.h"
#include "core/terrain/height_range.h"
#include "core/terrain/preparation.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

// Working memory of one generating thread. Grows to what the largest tile needs
// and stays there.
class TileScratch {
 public:
  TileScratch();
  ~TileScratch();
  TileScratch(TileScratch&&) noexcept;
  TileScratch& operator=(TileScratch&&) noexcept;

  struct Buffers;
  Buffers& buffers() { return *buffers_; }

 private:
  std::unique_ptr<Buffers> buffers_;
};

// What to generate. A 1-D terrain has y = 0 and height = 1.
struct TileRequest {
  int level = 0;
  Sampling sampling = Sampling::kPoint;
  Window window;
};

class Terrain {
 public:
  // Validates the spec, fills in what is not set and prepares: calibrates a
  // refinement, snaps and indexes constraints, prefilters rasters, conditions
  // the process on the spot heights. Errors: INVALID_ARGUMENT with violations
  // (field paths relative to the recipe, such as "roughness" or
  // "spots.points[3]"), CANCELLED.
  static absl::StatusOr<std::shared_ptr<const Terrain>> Create(
      TerrainSpec spec, const Preparation& preparation = {});

  // Of a valid spec, without preparing it.
  static PreparationCost EstimatePreparation(const TerrainSpec& spec);

  ~Terrain();
  Terrain(const Terrain&) = delete;
  Terrain& operator=(const Terrain&) = delete;

  // The spec with every optional of it filled in, but for soft_limit and an
  // endless domain, which stay unset.
  const TerrainSpec& spec() const;

  // The samples of the whole bounded domain at a level; nothing when endless.
  std::optional<Window> Extent(int level, Sampling sampling) const;

  // What is wrong with a request: level, index range, outside a bounded domain.
  // Field names: "level", "window.x", "window.y", "window.width",
  // "window.height".
  absl::Status CheckRequest(const TileRequest& request) const;

  // Writes window.width * window.height heights, row-major; NaN where there is
  // no data. `out` must have that size. Memory and errors: the scratch grows to
  // what a block needs, whatever the window. CANCELLED when `stop` was asked to
  // (polled at least every millisecond of work), INVALID_ARGUMENT as
  // CheckRequest.
  absl::Status Generate(const TileRequest& request, std::stop_token stop,
                        TileScratch* scratch, std::span<float> out) const;

  // The macro shape alone, d(p), at the same samples.
  absl::Status GenerateMacro(const TileRequest& request, TileScratch* scratch,
                             std::span<float> out) const;

  // P_fbm alone, before any mapping: what the statistics of the method speak
  // of.
  absl::Status GenerateFractal(const TileRequest& request, std::stop_token stop,
                               TileScratch* scratch,
                               std::span<float> out) const;

  // Heights at scattered world points: POINT samples of `level`, interpolated
  // bilinearly. Points outside a bounded domain are INVALID_ARGUMENT, naming
  // "points[i]".
  absl::Status GenerateAt(int level, std::span<const Point2> points,
                          std::stop_token stop, TileScratch* scratch,
                          std::span<float> out) const;

  // What became of the spot heights; nothing without any.
  std::optional<SpotReport> spots() const;

  // Memory that the terrain holds beyond its spec.
  std::int64_t MemoryBytes() const;

  // Lattice points that generating the window takes, ancestors included.
  std::int64_t GeneratedPoints(const TileRequest& request) const;

  // Largest possible |D - d|; nothing when unbounded.
  std::optional<double> DeviationBound() const;

  // A range that holds every height (BOLTZMANN, soft limit), or all but about
  // one in 10^8 (LINEAR): the default range of 16-bit encodings.
  HeightRange LikelyRange() const;

 private:
  class Impl;
  explicit Terrain(std::unique_ptr<const Impl> impl);
  std::unique_ptr<const Impl> impl_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_TERRAIN_H_
