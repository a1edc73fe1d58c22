// Random recipes and windows that go together: what the property tests run
// over.
//
// A case has its constraints and macro shape around its window, at scales from
// a few samples to many windows, so that every ingredient is felt whatever the
// level and the position. Every case is a function of the seed alone.
#ifndef TERRANE_TESTS_PROPERTY_RANDOM_TERRAIN_H_
#define TERRANE_TESTS_PROPERTY_RANDOM_TERRAIN_H_

#include <cstdint>
#include <memory>
#include <random>
#include <string>

#include "core/terrain/terrain.h"

namespace terrane::core {

// Integers and reals that do not depend on the standard library's vendor.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  // In [low, high], both included.
  std::int64_t Integer(std::int64_t low, std::int64_t high);
  // In [low, high).
  double Real(double low, double high);
  bool OneIn(int n) { return Integer(1, n) == 1; }
  template <class... T>
  auto Of(T... choices) {
    const std::common_type_t<T...> all[] = {choices...};
    return all[Integer(0, sizeof...(choices) - 1)];
  }

 private:
  std::mt19937_64 engine_;
};

// Rolling ground with a steep step and, if asked for, a lake without data.
std::shared_ptr<const Raster> MakeRaster(std::int64_t width,
                                         std::int64_t height,
                                         const Frame& frame, bool with_lake);

struct RandomCase {
  TerrainSpec spec;
  TileRequest request;

  // What a failure prints.
  std::string Text() const;
};

// A 2-D case in five of six; AREA sampling in one of three. The window has at
// most `largest` samples a side.
RandomCase MakeRandomCase(std::uint64_t seed, std::int64_t largest);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_PROPERTY_RANDOM_TERRAIN_H_
