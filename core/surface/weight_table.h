// WeightTable: the initial weights and the draws of one network.
//
// The weight of input (i, j) starts at base + random U; inputs of a network
// over one axis have j = 0. U and the U of the desired response are 16 random
// bits (the paper's random() has 15), a pure function of (seed, network, it,
// iu, weight): the two weights 2p and 2p + 1 of a row share the halves of one
// hash. So the table is kept in pairs, padded with a weight of 0.
//
// Immutable; safe from any thread. Determinism: integer arithmetic.
#ifndef TERRANE_CORE_SURFACE_WEIGHT_TABLE_H_
#define TERRANE_CORE_SURFACE_WEIGHT_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/noise/counter_hash.h"
#include "core/surface/surface_spec.h"

namespace terrane::core {

// One unit of 16 random bits.
inline constexpr double kDrawUnit = 1.0 / 65536.0;

struct InitialWeight {
  double base = 0;
  double random = 0;
  bool redraw = false;
};

class WeightTable {
 public:
  // `stream` tells the networks of a surface apart. A network over f_j(u) has
  // its j along the table's columns: `transposed`.
  WeightTable(const Network& network, std::int64_t seed, std::uint32_t stream,
              int columns, int rows, bool transposed);

  // Pairs of weights in a row.
  int pairs() const { return pairs_; }
  const InitialWeight& At(int i, int j) const {
    return weights_[static_cast<std::size_t>(j * 2 * pairs_ + i)];
  }

  double desired() const { return desired_; }
  double desired_random() const { return desired_random_; }

  // The keys that row `iu` of the grid adds to HashLane(ColumnWord(it), key).
  // The weight 2 pair has the low half of the bits, 2 pair + 1 the high half;
  // the desired response has the low half of its own.
  RowKey PairKey(int pair, int j, std::int64_t iu) const {
    return MakeRowKey(
        pair_streams_[static_cast<std::size_t>(j * pairs_ + pair)], iu);
  }
  RowKey DesiredKey(std::int64_t iu) const {
    return MakeRowKey(desired_stream_, iu);
  }

  // One sample's draws, for code that takes them one by one.
  double Initial(int i, int j, std::int64_t it, std::int64_t iu) const;
  double Desired(std::int64_t it, std::int64_t iu) const;

 private:
  int pairs_;
  std::vector<InitialWeight> weights_;
  std::vector<std::uint64_t> pair_streams_;
  double desired_;
  double desired_random_;
  std::uint64_t desired_stream_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_WEIGHT_TABLE_H_
