// Hillshade: how bright a surface of heights looks under one distant light.
//
// The slope is Horn's: differences of the 3 x 3 neighbourhood, weighted 1-2-1
// across the direction (Horn, "Hill shading and the reflectance map", Proc.
// IEEE 69(1), 1981), one-sided at the border, so that a plane has its analytic
// value everywhere. The brightness is Lambert's: the cosine between the surface
// normal and the light, 0 on the far side.
//
// Units: heights and spacing in the same unit (metres). Rows run from north to
// south, columns from west to east. The caller owns all memory. Pure functions,
// safe from any thread; they use only IEEE operations in a fixed order, so the
// result has the same bits everywhere. No errors.
#ifndef TERRANE_CORE_GRID_HILLSHADE_H_
#define TERRANE_CORE_GRID_HILLSHADE_H_

#include <cstdint>
#include <span>
#include <vector>

namespace terrane::core {

// Row-major heights that someone else owns; NaN where there is no data.
struct HeightView {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::span<const float> values;

  float At(std::int64_t i, std::int64_t j) const {
    return values[static_cast<std::size_t>(j * width + i)];
  }
};

// Ground distance of neighbouring samples, both above 0.
struct GroundSpacing {
  double x = 1;
  double y = 1;
};

// Ground spacing of every row. On a geographic grid it changes from row to row;
// on a projected one a single entry serves all rows.
class GroundScale {
 public:
  explicit GroundScale(GroundSpacing all_rows) : rows_{all_rows} {}
  // One entry a row.
  explicit GroundScale(std::vector<GroundSpacing> rows)
      : rows_(std::move(rows)) {}

  const GroundSpacing& Row(std::int64_t j) const {
    return rows_.size() == 1 ? rows_.front()
                             : rows_[static_cast<std::size_t>(j)];
  }

 private:
  std::vector<GroundSpacing> rows_;
};

// Unit vector towards the light. The default stands in the north-west (azimuth
// 315 degrees), 45 degrees high, where readers of maps expect it.
struct Light {
  double east = -0.5;
  double north = 0.5;
  double up = 0.70710678118654752;
};

// Writes one brightness in [0, 1] a sample, NaN where there is no data; `shade`
// has the view's size. `exaggeration` multiplies the heights. A neighbour
// without data counts as being level with the sample.
void Hillshade(const HeightView& heights, const GroundScale& scale,
               const Light& light, double exaggeration, std::span<float> shade);

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_HILLSHADE_H_
