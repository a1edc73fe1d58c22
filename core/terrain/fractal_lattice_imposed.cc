// What is imposed on the lattice: corrections of displacements, spots that
// stay, and the paper's discrete constraints with their buffers.
#include "core/terrain/displacement_draw.h"
#include "core/terrain/fractal_lattice.h"

namespace terrane::core {
namespace {

constexpr float kThird = 1.0f / 3;

}  // namespace

// --- Spot heights -----------------------------------------------------------

void FractalLattice::Correct(int level, HalfStep step, std::int64_t x,
                             std::int64_t y, std::int64_t spacing, int columns,
                             int rows, GridView plane) const {
  if (imposed_.corrections == nullptr) return;
  imposed_.corrections->AddTo(HalfStepSlot(level, step), x, y, spacing, columns,
                              rows, plane);
}

// Source SUCCESSIVE displaces every point at every level, but for the spots:
// they stay where they are.
void FractalLattice::RememberHeld(int level, const Grid& parent,
                                  Scratch* scratch) const {
  scratch->held.clear();
  if (imposed_.pins == nullptr) return;
  imposed_.pins->Find(level - 1, parent.x, parent.y, 1, parent.columns,
                      parent.rows, &scratch->pins);
  for (const SpotPins::Found& pin : scratch->pins) {
    scratch->held.push_back(
        {{parent.x + pin.i, parent.y + pin.j}, parent.view.At(pin.i, pin.j)});
  }
}

void FractalLattice::RestoreHeld(const Grid& grid, std::int64_t spacing,
                                 const Scratch& scratch) {
  for (const Held& held : scratch.held) {
    const std::int64_t i = spacing * held.point.x - grid.x;
    const std::int64_t j = spacing * held.point.y - grid.y;
    if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows) continue;
    grid.view.At(i, j) = held.value;
  }
}

// --- Discrete constraints ---------------------------------------------------

bool FractalLattice::OnBorder(const LatticePoint& point, int level) const {
  if (!config_.mirror.domain) return false;
  return point.x == 0 || point.x == config_.mirror.domain->cells_x << level ||
         point.y == 0 || point.y == config_.mirror.domain->cells_y << level;
}

// Eq. 11: half way from p* to each of its M parents, the next level's points
// get B = -P(p*) / M into their initial value. `plane` holds the points (x, y)
// + spacing (i, j) of `level`.
void FractalLattice::AddBuffers(HalfStep step, std::int64_t x, std::int64_t y,
                                std::int64_t spacing, int columns, int rows,
                                GridView plane, const Scratch& scratch) const {
  for (const Buffered& buffered : scratch.buffered) {
    const LatticePoint& p = buffered.point;
    const bool centre = (p.x & 1) != 0 && (p.y & 1) != 0;
    if (centre != (step == HalfStep::kCentre)) continue;
    const bool border = !centre && OnBorder(p, buffered.level);
    const float share = buffered.value * (border ? -kThird : -0.25f);
    constexpr int kDiagonal[4][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    constexpr int kAxis[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    for (int k = 0; k < 4; ++k) {
      const int* offset = centre ? kDiagonal[k] : kAxis[k];
      const std::int64_t i = 2 * p.x + offset[0] - x;
      const std::int64_t j = 2 * p.y + offset[1] - y;
      if (i < 0 || j < 0 || i >= spacing * columns || j >= spacing * rows) {
        continue;
      }
      plane.At(i / spacing, j / spacing) += share;
    }
  }
}

// Sets P(p*) = 0 and remembers what it was. Points of level 0 have no parents,
// so they have no buffer.
void FractalLattice::MeetConstraints(int level, std::int64_t x, std::int64_t y,
                                     std::int64_t spacing, int columns,
                                     int rows, GridView plane,
                                     Scratch* scratch) const {
  if (imposed_.constraints == nullptr || imposed_.constraints->empty()) return;
  scratch->buffered.clear();  // those of the level before are in place by now
  scratch->found.clear();
  imposed_.constraints->Find(
      level, {x, y, spacing * (columns - 1) + 1, spacing * (rows - 1) + 1},
      &scratch->found);
  for (const LatticePoint& point : scratch->found) {
    const std::int64_t dx = point.x - x;
    const std::int64_t dy = point.y - y;
    if (dx % spacing != 0 || dy % spacing != 0) continue;
    float& value = plane.At(dx / spacing, dy / spacing);
    if (level > 0) scratch->buffered.push_back({point, level, value});
    value = 0;
  }
}

}  // namespace terrane::core
