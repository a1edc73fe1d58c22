// The fitness of a chromosome: how well it agrees with the shape that was asked
// for, each feature 0 to 10, summed.
//
//   axis, side   10 * (requested share of the value)
//   length       code mapped evenly onto 0-10, short or long as wanted
//   angle        the same, narrow or wide
//   count        3 * count where many are wanted, 9 - 3 * count where few are
//   gaps         clamp(round(10 (1 - 2 g)), 0, 10) where branches shall be
//                dense, 10 minus that where sparse; g is the mean gap between
//                branches as a share of the length; 5 with one branch, or at
//                the tip of a sympodial branch, which has no gaps
// A feature in which nothing is wanted counts nothing. Immutable, safe from any
// thread; integers only.
//
// Source: Wu & Zhou 2008, section 2.3 (2).
#ifndef TERRANE_CORE_TREE_FITNESS_H_
#define TERRANE_CORE_TREE_FITNESS_H_

#include <array>
#include <cstdint>

#include "core/tree/chromosome.h"
#include "core/tree/tree_spec.h"

namespace terrane::core {

class Fitness {
 public:
  explicit Fitness(const GeneticSpec& spec);

  int Of(std::uint32_t chromosome) const;

 private:
  // By code. Angle and length share the lower ten bits of a chromosome, axis,
  // side and count the next four.
  std::array<std::uint8_t, 1 << 10> length_and_angle_ = {};
  std::array<std::uint8_t, 1 << 4> axis_side_and_count_ = {};
  // By distance of the outermost positions, of two and of three branches.
  std::array<std::array<std::uint8_t, kPositionCodeMax + 1>, 2> gaps_ = {};
  bool counts_gaps_ = false;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_FITNESS_H_
