// How large the displacement of each point is: by H at the point (uniform, or
// steered by continuous constraints) and, in a refinement, by the calibrated
// amplitude at the point.
//
// Deviations are for sigma = 1. Immutable and thread-safe. Determinism: the
// deviation of a point depends on the point alone.
// Source: Tan & Chen 2003, eq. 5 with H = H(p); core/terrain/displacement.h.
#ifndef TERRANE_CORE_TERRAIN_DEVIATION_MODEL_H_
#define TERRANE_CORE_TERRAIN_DEVIATION_MODEL_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/grid/grid_view.h"
#include "core/grid/lattice_window.h"
#include "core/grid/raster_sampler.h"
#include "core/terrain/constraint_field.h"
#include "core/terrain/displacement.h"
#include "core/terrain/lattice_kernels.h"
#include "core/terrain/mirror.h"

namespace terrane::core {

// Points first + 2i of one axis at one level.
struct EverySecond {
  std::int64_t first = 0;
  int count = 0;
};

class DeviationModel {
 public:
  struct Config {
    FractalSource source = FractalSource::kSubdivision;
    int dimensions = 2;
    Frame frame;
    Mirror mirror;
    double roughness = 0.8;
    // H as a function of the point; null or empty: `roughness` everywhere.
    std::shared_ptr<const ConstraintField> roughness_field;
    // Relative amplitude in (u, v); null: 1 everywhere.
    std::shared_ptr<const RasterSampler> amplitude;
  };

  // Working memory; belongs to one thread.
  struct Scratch {
    SampleGrid grid;
    GridBuffer roughness;
    GridBuffer inside;
    // Of the tile at work: once it was asked to, deviations are meaningless.
    std::stop_token stop;
  };

  explicit DeviationModel(Config config);

  float level0() const { return level0_; }

  // Deviations of the points columns x rows that appear in `step` of `level`:
  // uniform where they are all alike, else a plane in `buffer`, (i, j) for the
  // point (columns.first + 2 i, rows.first + 2 j). A 1-D lattice has one row.
  Deviation At(int level, HalfStep step, EverySecond columns, EverySecond rows,
               GridBuffer* buffer, Scratch* scratch) const;

 private:
  // Deviation by H for one half step at kTableSize equally spaced H, linear
  // between.
  using Table = std::vector<float>;

  void MakeTables(float minimum, float maximum);
  float LookUp(const Table& table, float roughness) const;
  void FillPlane(int level, HalfStep step, const SampleGrid& grid,
                 GridView plane, bool by_roughness,
                 const GridView& roughness) const;

  Config config_;
  float level0_;
  std::vector<float> uniform_;  // by 2 level + half step
  std::vector<Table> tables_;   // the same; empty without a field
  float table_minimum_ = 0;     // H of the first entry
  float table_scale_ = 0;       // entries per unit of H
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_DEVIATION_MODEL_H_
