// P_fbm over the plane: any window at any level of the endless dyadic lattice.
//
// A point of level n depends on a few points of level n-1 around it, so a
// window at level n needs the window at level n-1 that is half as large and a
// constant wider. Generating walks down from the few level-0 points above the
// window; a w x w tile takes about 4/3 (w + 6)^2 points whatever its level.
// Nothing is stored between calls.
//
// Values are for sigma = 1. Immutable and thread-safe; a Scratch belongs to one
// thread at a time. Determinism: a value is a function of (config, level,
// index).
//
// Source: Tan & Chen 2003, eqs. 5, 11, 12; Saupe 1988 for the half steps;
// SUBDIVISION is Terrane's own (docs/terrain.md).
#ifndef TERRANE_CORE_TERRAIN_FRACTAL_LATTICE_H_
#define TERRANE_CORE_TERRAIN_FRACTAL_LATTICE_H_

#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "core/grid/grid_view.h"
#include "core/terrain/deviation_model.h"
#include "core/terrain/imposed.h"
#include "core/terrain/lattice_kernels.h"
#include "core/terrain/mirror.h"

namespace terrane::core {

class FractalLattice {
 public:
  struct Config {
    std::int64_t seed = 0;
    FractalSource source = FractalSource::kSubdivision;
    Mirror mirror;
    // Level 0 is 0 everywhere (a refinement: its posts are met exactly).
    bool flat_level0 = false;
  };

  // A discrete constraint that was just met: its neighbours are due their
  // buffer at the next level.
  struct Buffered {
    LatticePoint point;
    int level = 0;
    float value = 0;  // P(p*) before it became 0
  };

  // A spot that stays, in indices of the level before, and its value.
  struct Held {
    LatticePoint point;
    float value = 0;
  };

  // A computed rectangle of one level: view(0, 0) is point (x, y).
  struct Grid {
    GridView view;
    std::int64_t x = 0, y = 0;
    int columns = 0, rows = 0;
  };
  // The last coarse ancestors that were computed, for the next tile nearby:
  // tiles share them, and they cost as much as a small tile does.
  struct Checkpoint {
    std::uint64_t lattice = 0;  // whose they are; 0: nobody's
    int level = 0;
    Window window;
    GridBuffer buffer;
    Grid grid;
    std::vector<Buffered> buffered;
  };

  struct Scratch {
    GridBuffer grids[2];
    GridBuffer centres, ring;
    GridBuffer deviations[4];
    DeviationModel::Scratch model;
    std::vector<std::uint32_t> even_words, odd_words;
    std::vector<RowKey> even_keys, odd_keys;
    std::vector<LatticePoint> found;
    std::vector<Buffered> buffered;
    std::vector<SpotPins::Found> pins;
    std::vector<Held> held;
    Checkpoint checkpoint;
  };

  FractalLattice(Config config, DeviationModel model, Imposed imposed);

  // POINT samples of `level`: the plane's (0, 0) is the window's first sample.
  // The plane lives in the scratch until its next use. A null plane: stopped.
  GridView Points(int level, const Window& window, const std::stop_token& stop,
                  Scratch* scratch) const;

  // AREA samples of `level`: the centre points of level + 1 after their half
  // step.
  GridView Centres(int level, const Window& window, const std::stop_token& stop,
                   Scratch* scratch) const;

  // Lattice points that Points or Centres computes for such a window.
  std::int64_t PointsComputed(int level, std::int64_t width,
                              std::int64_t height) const;

 private:
  // One half step's deviations: horizontal edges, vertical edges, corners and
  // centres, as far as they are displaced in it.
  struct EdgeDeviations {
    Deviation horizontal, vertical, corner, centre;
  };

  Window ParentOf(const Window& child) const;
  std::vector<Window> Ancestors(int level, const Window& window) const;
  Grid Level0(const Window& window, Scratch* scratch) const;
  Grid Compute(int level, const Window& window, const std::stop_token& stop,
               Scratch* scratch) const;
  Grid Descend(Grid grid, int start, const std::vector<Window>& windows,
               const std::stop_token& stop, Scratch* scratch) const;
  int CheckpointLevel(const std::vector<Window>& windows) const;
  bool UpdateCheckpoint(int level, const Window& needed,
                        const std::stop_token& stop, Scratch* scratch) const;
  static Grid Crop(const Grid& grid, const Window& window);
  Grid Refine(int level, const Grid& parent, GridView child,
              Scratch* scratch) const;

  void PrepareWords(int level, const Grid& parent, Scratch* scratch) const;
  void PrepareKeys(int level, HalfStep step, const Grid& parent,
                   Scratch* scratch) const;
  Deviation DeviationOf(int level, HalfStep step, const Grid& parent,
                        int column_parity, int row_parity, int slot,
                        Scratch* scratch) const;
  EdgeDeviations DeviationsOfEdges(int level, const Grid& parent,
                                   Scratch* scratch) const;

  GridView RefineCentres(int level, const Grid& parent, int first,
                         int column_end, int row_end, Scratch* scratch) const;
  Grid RefineEdges(int level, const Grid& parent, GridView centres,
                   GridView child, Scratch* scratch) const;

  void MendBorderColumns(int level, const Grid& parent, GridView centres,
                         const Deviation& vertical, const Scratch& scratch,
                         Grid* child) const;
  void MendBorderRows(int level, const Grid& parent, GridView centres,
                      const Deviation& horizontal, const Scratch& scratch,
                      Grid* child) const;
  void Correct(int level, HalfStep step, std::int64_t x, std::int64_t y,
               std::int64_t spacing, int columns, int rows,
               GridView plane) const;
  void RememberHeld(int level, const Grid& parent, Scratch* scratch) const;
  static void RestoreHeld(const Grid& grid, std::int64_t spacing,
                          const Scratch& scratch);
  void AddBuffers(HalfStep step, std::int64_t x, std::int64_t y,
                  std::int64_t spacing, int columns, int rows, GridView plane,
                  const Scratch& scratch) const;
  void MeetConstraints(int level, std::int64_t x, std::int64_t y,
                       std::int64_t spacing, int columns, int rows,
                       GridView plane, Scratch* scratch) const;
  bool OnBorder(const LatticePoint& point, int level) const;

  Config config_;
  DeviationModel model_;
  Imposed imposed_;
  std::uint64_t id_;
  Stencil stencil_;
  int margin_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_FRACTAL_LATTICE_H_
