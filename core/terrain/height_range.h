// A range of heights.
#ifndef TERRANE_CORE_TERRAIN_HEIGHT_RANGE_H_
#define TERRANE_CORE_TERRAIN_HEIGHT_RANGE_H_

namespace terrane::core {

// A closed range of heights.
struct HeightRange {
  float minimum = 0;
  float maximum = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_HEIGHT_RANGE_H_
