// P_fbm point by point, straight from the method: the scalar reference that the
// SIMD lattice is held to, bit for bit.
//
// A value is worked out by recursion on its parents, one at a time, with a
// memo: slow, and plain enough to be checked against docs/terrain.md by
// reading. Sums are written in the order that core/terrain/lattice_kernels.h
// promises.
#ifndef TERRANE_TESTS_CORE_LATTICE_REFERENCE_H_
#define TERRANE_TESTS_CORE_LATTICE_REFERENCE_H_

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "core/terrain/terrain_spec.h"

namespace terrane::core {

class LatticeReference {
 public:
  LatticeReference(std::int64_t seed, FractalSource source, double roughness,
                   std::optional<Domain> domain);

  // Holds a point that appears at `level` at 0 (MIDPOINT).
  void Constrain(int level, std::int64_t x, std::int64_t y);

  // POINT sample (x, y) of `level`, for sigma = 1.
  float Point(int level, std::int64_t x, std::int64_t y);

  // AREA sample: centre of cell (x, y) of `level`.
  float Area(int level, std::int64_t x, std::int64_t y);

 private:
  using Key = std::tuple<int, std::int64_t, std::int64_t>;

  std::int64_t ReflectX(int level, std::int64_t x) const;
  std::int64_t ReflectY(int level, std::int64_t y) const;
  bool OnBorder(int level, std::int64_t x, std::int64_t y) const;
  bool Constrained(int level, std::int64_t x, std::int64_t y) const;
  // The random displacement that half step `half` (0 centres, 1 edges) draws.
  float Displacement(int level, int half, std::int64_t x, std::int64_t y) const;
  // What discrete constraints of the level before put into a point's start.
  float Buffer(int level, std::int64_t x, std::int64_t y);
  float Corner(int level, std::int64_t x, std::int64_t y);  // as edges see it
  float Centre(int level, std::int64_t x, std::int64_t y);  // as edges see it
  float Edge(int level, std::int64_t x, std::int64_t y);
  // A point before it is set to 0 by its own constraint.
  float Unconstrained(int level, std::int64_t x, std::int64_t y);

  std::int64_t seed_;
  FractalSource source_;
  double roughness_;
  std::optional<Domain> domain_;
  std::set<Key> constrained_;
  std::map<Key, float> memo_, centres_;
};

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_LATTICE_REFERENCE_H_
