#include "core/terrain/fractal_lattice.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/noise/counter_hash.h"
#include "core/noise/normal.h"
#include "core/terrain/displacement_draw.h"

namespace terrane::core {
namespace {

constexpr float kThird = 1.0f / 3;

std::int64_t FloorHalf(std::int64_t x) { return x >> 1; }

// Windows of at most this size are worth a checkpoint, from this level on.
constexpr std::int64_t kCheckpointSize = 16;
constexpr int kLeastCheckpointLevel = 3;

bool Contains(const Window& outer, const Window& inner) {
  return inner.x >= outer.x && inner.y >= outer.y &&
         inner.x + inner.width <= outer.x + outer.width &&
         inner.y + inner.height <= outer.y + outer.height;
}

// The window and what tiles to the right and below will need.
Window Widened(const Window& window) {
  return {window.x, window.y, window.width + 2 * kCheckpointSize,
          window.height + kCheckpointSize};
}

// Tells one lattice from another in a scratch; never used twice.
std::uint64_t NextId() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

float DeviationAt(const Deviation& deviation, int i, int j) {
  return deviation.varies() ? deviation.per_point.At(i, j) : deviation.uniform;
}

}  // namespace

FractalLattice::FractalLattice(Config config, DeviationModel model,
                               Imposed imposed)
    : config_(std::move(config)),
      model_(std::move(model)),
      imposed_(std::move(imposed)),
      id_(NextId()),
      stencil_(config_.source == FractalSource::kSubdivision
                   ? Stencil::kSubdivision
                   : Stencil::kMidpoint),
      margin_(stencil_ == Stencil::kSubdivision ? kSubdivisionMargin
                                                : kMidpointMargin) {}

// The corners that the cells over `child` need around them.
Window FractalLattice::ParentOf(const Window& child) const {
  const std::int64_t x = FloorHalf(child.x);
  const std::int64_t y = FloorHalf(child.y);
  return {x - margin_, y - margin_,
          FloorHalf(child.x + child.width + 1) - x + 2 * margin_,
          FloorHalf(child.y + child.height + 1) - y + 2 * margin_};
}

// Windows from `level` (first) down to level 0 (last).
std::vector<Window> FractalLattice::Ancestors(int level,
                                              const Window& window) const {
  std::vector<Window> windows = {window};
  for (int n = level; n > 0; --n) windows.push_back(ParentOf(windows.back()));
  return windows;
}

std::int64_t FractalLattice::PointsComputed(int level, std::int64_t width,
                                            std::int64_t height) const {
  std::int64_t points = 0;
  for (const Window& window : Ancestors(level, {0, 0, width, height})) {
    points += window.width * window.height;
  }
  return points;
}

GridView FractalLattice::Points(int level, const Window& window,
                                const std::stop_token& stop,
                                Scratch* scratch) const {
  return Compute(level, window, stop, scratch).view;
}

GridView FractalLattice::Centres(int level, const Window& window,
                                 const std::stop_token& stop,
                                 Scratch* scratch) const {
  // Centre (i, j) of this level's cells needs corners from i - reach to
  // i + 1 + reach.
  const int reach = (margin_ - 1) / 2;
  const Window corners = {window.x - reach, window.y - reach,
                          window.width + 1 + 2 * reach,
                          window.height + 1 + 2 * reach};
  const Grid parent = Compute(level, corners, stop, scratch);
  if (parent.view.data == nullptr) return {};
  const int fine = level + 1;
  const GridView centres =
      RefineCentres(fine, parent, reach, static_cast<int>(window.width) + reach,
                    static_cast<int>(window.height) + reach, scratch);
  const GridView result = {&centres.At(reach, reach), centres.stride};
  MeetConstraints(fine, 2 * window.x + 1, 2 * window.y + 1, 2,
                  static_cast<int>(window.width),
                  static_cast<int>(window.height), result, scratch);
  return result;
}

FractalLattice::Grid FractalLattice::Compute(int level, const Window& window,
                                             const std::stop_token& stop,
                                             Scratch* scratch) const {
  const std::vector<Window> windows = Ancestors(level, window);
  scratch->model.stop = stop;
  const int start = CheckpointLevel(windows);
  if (start == 0) {
    return Descend(Level0(windows.back(), scratch), 0, windows, stop, scratch);
  }
  const Window& needed = windows[static_cast<std::size_t>(level - start)];
  if (!UpdateCheckpoint(start, needed, stop, scratch)) return {};
  const Checkpoint& checkpoint = scratch->checkpoint;
  scratch->buffered = checkpoint.buffered;
  return Descend(Crop(checkpoint.grid, needed), start, windows, stop, scratch);
}

// From a grid of level `start` to the window of the finest level,
// windows.front().
FractalLattice::Grid FractalLattice::Descend(Grid grid, int start,
                                             const std::vector<Window>& windows,
                                             const std::stop_token& stop,
                                             Scratch* scratch) const {
  const auto level = static_cast<int>(windows.size()) - 1;
  for (int n = start + 1; n <= level; ++n) {
    if (stop.stop_requested()) return {};
    const GridView child = scratch->grids[n % 2].Shape(
        2 * (grid.columns - 2 * margin_), 2 * (grid.rows - 2 * margin_));
    // Whole cells are refined; what stands over the window would grow with
    // every further level.
    grid = Crop(Refine(n, grid, child, scratch),
                windows[static_cast<std::size_t>(level - n)]);
  }
  return grid;
}

// The finest level where the window is small: from there up, neighbouring tiles
// share nearly everything. 0: too near the top to be worth keeping.
int FractalLattice::CheckpointLevel(const std::vector<Window>& windows) const {
  // SUCCESSIVE moves parents in place.
  if (config_.source == FractalSource::kSuccessive) return 0;
  const auto level = static_cast<int>(windows.size()) - 1;
  for (int n = level; n >= kLeastCheckpointLevel; --n) {
    const Window& window = windows[static_cast<std::size_t>(level - n)];
    if (std::max(window.width, window.height) <= kCheckpointSize) return n;
  }
  return 0;
}

// Makes the scratch's checkpoint hold `needed` at `level`. False: stopped.
bool FractalLattice::UpdateCheckpoint(int level, const Window& needed,
                                      const std::stop_token& stop,
                                      Scratch* scratch) const {
  Checkpoint& checkpoint = scratch->checkpoint;
  const bool same_level =
      checkpoint.lattice == id_ && checkpoint.level == level;
  if (same_level && Contains(checkpoint.window, needed)) return true;
  // A single tile pays for its own ancestors only; who asks for a second one on
  // the same level is likely to go on.
  const Window window = same_level ? Widened(needed) : needed;
  checkpoint.lattice = 0;
  const std::vector<Window> windows = Ancestors(level, window);
  const Grid made =
      Descend(Level0(windows.back(), scratch), 0, windows, stop, scratch);
  if (stop.stop_requested()) return false;
  const GridView kept = checkpoint.buffer.Shape(made.columns, made.rows);
  for (int j = 0; j < made.rows; ++j) {
    std::copy_n(made.view.Row(j), made.columns, kept.Row(j));
  }
  checkpoint.grid = made;
  checkpoint.grid.view = kept;
  checkpoint.buffered = scratch->buffered;
  checkpoint.lattice = id_;
  checkpoint.level = level;
  checkpoint.window = window;
  return true;
}

FractalLattice::Grid FractalLattice::Crop(const Grid& grid,
                                          const Window& window) {
  return {
      {&grid.view.At(window.x - grid.x, window.y - grid.y), grid.view.stride},
      window.x,
      window.y,
      static_cast<int>(window.width),
      static_cast<int>(window.height)};
}

FractalLattice::Grid FractalLattice::Level0(const Window& window,
                                            Scratch* scratch) const {
  scratch->buffered.clear();
  const Grid grid = {scratch->grids[0].Shape(window.width, window.height),
                     window.x, window.y, static_cast<int>(window.width),
                     static_cast<int>(window.height)};
  for (int j = 0; j < grid.rows; ++j) {
    std::fill_n(grid.view.Row(j), grid.columns + kRowSlack, 0.0f);
  }
  if (config_.flat_level0) return grid;
  scratch->even_words.assign(static_cast<std::size_t>(grid.columns + kRowSlack),
                             0);
  for (int i = 0; i < grid.columns; ++i) {
    scratch->even_words[static_cast<std::size_t>(i)] =
        ColumnWord(config_.mirror.X(grid.x + i, 0));
  }
  const std::uint64_t stream =
      StreamKey(config_.seed, PlaneStream(0, HalfStep::kEdge));
  scratch->even_keys.resize(static_cast<std::size_t>(grid.rows));
  for (int j = 0; j < grid.rows; ++j) {
    scratch->even_keys[static_cast<std::size_t>(j)] =
        MakeRowKey(stream, config_.mirror.Y(grid.y + j, 0));
  }
  AddDisplacements(grid.view, grid.columns, grid.rows,
                   scratch->even_words.data(), scratch->even_keys.data(),
                   {model_.level0(), {}});
  Correct(0, HalfStep::kEdge, grid.x, grid.y, 1, grid.columns, grid.rows,
          grid.view);
  MeetConstraints(0, grid.x, grid.y, 1, grid.columns, grid.rows, grid.view,
                  scratch);
  return grid;
}

// --- One level --------------------------------------------------------------

FractalLattice::Grid FractalLattice::Refine(int level, const Grid& parent,
                                            GridView child,
                                            Scratch* scratch) const {
  const int reach = (margin_ - 1) / 2;
  const GridView centres =
      RefineCentres(level, parent, reach, parent.columns - 1 - reach,
                    parent.rows - 1 - reach, scratch);
  if (config_.source != FractalSource::kSuccessive) {
    return RefineEdges(level, parent, centres, child, scratch);
  }
  // Corners move after the centres were computed from where they stood (Saupe's
  // MidPointFM2D with addition).
  RememberHeld(level, parent, scratch);
  const Deviation deviation =
      DeviationOf(level, HalfStep::kCentre, parent, 0, 0, 0, scratch);
  AddDisplacements(parent.view, parent.columns, parent.rows,
                   scratch->even_words.data(), scratch->even_keys.data(),
                   deviation);
  Correct(level, HalfStep::kCentre, 2 * parent.x, 2 * parent.y, 2,
          parent.columns, parent.rows, parent.view);
  RestoreHeld(parent, 1, *scratch);
  const Grid refined = RefineEdges(level, parent, centres, child, scratch);
  RestoreHeld(refined, 2, *scratch);
  return refined;
}

GridView FractalLattice::RefineCentres(int level, const Grid& parent, int first,
                                       int column_end, int row_end,
                                       Scratch* scratch) const {
  PrepareWords(level, parent, scratch);
  PrepareKeys(level, HalfStep::kCentre, parent, scratch);
  CentreStep step;
  step.stencil = stencil_;
  step.parent = parent.view;
  step.centres = scratch->centres.Shape(parent.columns, parent.rows);
  step.first_column = first;
  step.last_column = column_end;
  step.first_row = first;
  step.last_row = row_end;
  step.words = scratch->odd_words.data();
  step.keys = scratch->odd_keys.data();
  step.deviation =
      DeviationOf(level, HalfStep::kCentre, parent, 1, 1, 0, scratch);
  step.row_scratch = scratch->ring.Shape(parent.view.stride, 4).data;
  ComputeCentres(step);
  Correct(level, HalfStep::kCentre, 2 * parent.x + 1, 2 * parent.y + 1, 2,
          parent.columns - 1, parent.rows - 1, step.centres);
  AddBuffers(HalfStep::kCentre, 2 * parent.x + 1, 2 * parent.y + 1, 2,
             parent.columns - 1, parent.rows - 1, step.centres, *scratch);
  return step.centres;
}

FractalLattice::Grid FractalLattice::RefineEdges(int level, const Grid& parent,
                                                 GridView centres,
                                                 GridView child,
                                                 Scratch* scratch) const {
  PrepareKeys(level, HalfStep::kEdge, parent, scratch);
  const EdgeDeviations deviations = DeviationsOfEdges(level, parent, scratch);
  EdgeStep step;
  step.stencil = stencil_;
  step.displace_all = config_.source == FractalSource::kSuccessive;
  step.parent = parent.view;
  step.centres = centres;
  step.child = child;
  step.first_column = margin_;
  step.last_column = parent.columns - margin_;
  step.first_row = margin_;
  step.last_row = parent.rows - margin_;
  step.even_words = scratch->even_words.data();
  step.odd_words = scratch->odd_words.data();
  step.even_keys = scratch->even_keys.data();
  step.odd_keys = scratch->odd_keys.data();
  step.horizontal = deviations.horizontal;
  step.vertical = deviations.vertical;
  step.corner = deviations.corner;
  step.centre = deviations.centre;
  ComputeEdges(step);
  Grid grid = {child, 2 * (parent.x + margin_), 2 * (parent.y + margin_),
               2 * (parent.columns - 2 * margin_),
               2 * (parent.rows - 2 * margin_)};
  if (config_.mirror.domain && stencil_ == Stencil::kMidpoint) {
    MendBorderColumns(level, parent, centres, deviations.vertical, *scratch,
                      &grid);
    MendBorderRows(level, parent, centres, deviations.horizontal, *scratch,
                   &grid);
  }
  Correct(level, HalfStep::kEdge, grid.x, grid.y, 1, grid.columns, grid.rows,
          grid.view);
  AddBuffers(HalfStep::kEdge, grid.x, grid.y, 1, grid.columns, grid.rows,
             grid.view, *scratch);
  MeetConstraints(level, grid.x, grid.y, 1, grid.columns, grid.rows, grid.view,
                  scratch);
  return grid;
}

void FractalLattice::PrepareWords(int level, const Grid& parent,
                                  Scratch* scratch) const {
  const auto size = static_cast<std::size_t>(parent.columns + kRowSlack);
  scratch->even_words.resize(size);
  scratch->odd_words.resize(size);
  for (std::size_t i = 0; i < static_cast<std::size_t>(parent.columns); ++i) {
    const std::int64_t x = 2 * (parent.x + static_cast<std::int64_t>(i));
    scratch->even_words[i] = ColumnWord(config_.mirror.X(x, level));
    scratch->odd_words[i] = ColumnWord(config_.mirror.X(x + 1, level));
  }
}

void FractalLattice::PrepareKeys(int level, HalfStep step, const Grid& parent,
                                 Scratch* scratch) const {
  const std::uint64_t stream =
      StreamKey(config_.seed, PlaneStream(level, step));
  const auto size = static_cast<std::size_t>(parent.rows);
  scratch->even_keys.resize(size);
  scratch->odd_keys.resize(size);
  for (std::size_t j = 0; j < size; ++j) {
    const std::int64_t y = 2 * (parent.y + static_cast<std::int64_t>(j));
    scratch->even_keys[j] = MakeRowKey(stream, config_.mirror.Y(y, level));
    scratch->odd_keys[j] = MakeRowKey(stream, config_.mirror.Y(y + 1, level));
  }
}

Deviation FractalLattice::DeviationOf(int level, HalfStep step,
                                      const Grid& parent, int column_parity,
                                      int row_parity, int slot,
                                      Scratch* scratch) const {
  return model_.At(level, step, {2 * parent.x + column_parity, parent.columns},
                   {2 * parent.y + row_parity, parent.rows},
                   &scratch->deviations[slot], &scratch->model);
}

FractalLattice::EdgeDeviations FractalLattice::DeviationsOfEdges(
    int level, const Grid& parent, Scratch* scratch) const {
  const auto of = [&](int column_parity, int row_parity, int slot) {
    return DeviationOf(level, HalfStep::kEdge, parent, column_parity,
                       row_parity, slot, scratch);
  };
  EdgeDeviations deviations = {of(1, 0, 0), of(0, 1, 1), {}, {}};
  const bool displace_all = config_.source == FractalSource::kSuccessive;
  if (displace_all) {
    deviations.corner = of(0, 0, 2);
    deviations.centre = of(1, 1, 3);
  }
  // The kernel takes all from planes or none.
  const auto spread = [&](Deviation* deviation, int slot) {
    if (deviation->varies()) return;
    const GridView plane =
        scratch->deviations[slot].Shape(parent.columns, parent.rows);
    for (int j = 0; j < parent.rows; ++j) {
      std::fill_n(plane.Row(j), parent.columns + kRowSlack, deviation->uniform);
    }
    deviation->per_point = plane;
  };
  if (deviations.horizontal.varies() || deviations.vertical.varies() ||
      deviations.corner.varies() || deviations.centre.varies()) {
    spread(&deviations.horizontal, 0);
    spread(&deviations.vertical, 1);
    if (displace_all) {
      spread(&deviations.corner, 2);
      spread(&deviations.centre, 3);
    }
  }
  return deviations;
}

// --- The border of a bounded domain -----------------------------------------

// An edge point on the border has three parents (M = 3): two corners on the
// border, one centre inside.
void FractalLattice::MendBorderColumns(int level, const Grid& parent,
                                       GridView centres,
                                       const Deviation& vertical,
                                       const Scratch& scratch,
                                       Grid* child) const {
  const std::int64_t last = config_.mirror.domain->cells_x << level;
  for (const std::int64_t x : {std::int64_t{0}, last}) {
    if (x < child->x || x >= child->x + child->columns) continue;
    const auto column = static_cast<int>(x - child->x);
    const int i = static_cast<int>(x / 2 - parent.x);
    const int inside = x == 0 ? i : i - 1;
    const std::uint32_t word = scratch.even_words[static_cast<std::size_t>(i)];
    for (int j = margin_; j < parent.rows - margin_; ++j) {
      const RowKey key = scratch.odd_keys[static_cast<std::size_t>(j)];
      const float sum = (parent.view.At(i, j) + parent.view.At(i, j + 1)) +
                        centres.At(inside, j);
      child->view.At(column, 2 * (j - margin_) + 1) =
          sum * kThird +
          NormalFromBits(HashLane(word, key)) * DeviationAt(vertical, i, j);
    }
  }
}

void FractalLattice::MendBorderRows(int level, const Grid& parent,
                                    GridView centres,
                                    const Deviation& horizontal,
                                    const Scratch& scratch, Grid* child) const {
  const std::int64_t last = config_.mirror.domain->cells_y << level;
  for (const std::int64_t y : {std::int64_t{0}, last}) {
    if (y < child->y || y >= child->y + child->rows) continue;
    const auto row = static_cast<int>(y - child->y);
    const int j = static_cast<int>(y / 2 - parent.y);
    const int inside = y == 0 ? j : j - 1;
    const RowKey key = scratch.even_keys[static_cast<std::size_t>(j)];
    for (int i = margin_; i < parent.columns - margin_; ++i) {
      const std::uint32_t word = scratch.odd_words[static_cast<std::size_t>(i)];
      const float sum = (parent.view.At(i, j) + parent.view.At(i + 1, j)) +
                        centres.At(i, inside);
      child->view.At(2 * (i - margin_) + 1, row) =
          sum * kThird +
          NormalFromBits(HashLane(word, key)) * DeviationAt(horizontal, i, j);
    }
  }
}

}  // namespace terrane::core
