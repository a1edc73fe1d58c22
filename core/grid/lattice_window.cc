#include "core/grid/lattice_window.h"

#include <cmath>

namespace terrane::core {
namespace {

void FillAxis(double origin, double spacing, int level, std::int64_t first,
              std::int64_t step, std::int64_t count,
              std::vector<double>* level0_units, std::vector<double>* world) {
  level0_units->resize(static_cast<std::size_t>(count));
  world->resize(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    const double u = std::ldexp(static_cast<double>(first + step * i), -level);
    (*level0_units)[static_cast<std::size_t>(i)] = u;
    (*world)[static_cast<std::size_t>(i)] = origin + u * spacing;
  }
}

}  // namespace

void FillSampleGrid(const Frame& frame, int level, std::int64_t first_x,
                    std::int64_t first_y, std::int64_t step,
                    std::int64_t columns, std::int64_t rows, SampleGrid* grid) {
  FillAxis(frame.origin_x, frame.spacing_x, level, first_x, step, columns,
           &grid->u, &grid->x);
  FillAxis(frame.origin_y, frame.spacing_y, level, first_y, step, rows,
           &grid->v, &grid->y);
}

}  // namespace terrane::core
