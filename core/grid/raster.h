// A raster of heights placed in the world: an elevation model, in memory.
//
// Values are row-major, width * height of them; post (i, j) lies at
// frame.origin + (i, j) * frame.spacing. Posts without data are NaN. A Raster
// is immutable once made and shared between threads by shared_ptr<const
// Raster>.
#ifndef TERRANE_CORE_GRID_RASTER_H_
#define TERRANE_CORE_GRID_RASTER_H_

#include <cstdint>
#include <vector>

#include "core/grid/lattice_window.h"

namespace terrane::core {

struct Raster {
  std::int64_t width = 0;
  std::int64_t height = 0;
  Frame frame;
  std::vector<float> values;

  float At(std::int64_t i, std::int64_t j) const {
    return values[static_cast<std::size_t>(j * width + i)];
  }
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_RASTER_H_
