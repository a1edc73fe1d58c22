#include "core/surface/weight_table.h"

namespace terrane::core {
namespace {

// Streams of one network: the desired response and up to 64 x 32 pairs.
constexpr std::uint32_t kStreamsPerNetwork = 4096;

bool Selects(const WeightRule& rule, int i, int j) {
  return (!rule.i.has_value() || *rule.i == i) &&
         (!rule.j.has_value() || *rule.j == j);
}

// The last rule that selects the weight holds.
InitialWeight InitialOf(const Network& network, int i, int j) {
  InitialWeight weight{0, 1, false};
  for (const WeightRule& rule : network.weights) {
    if (!Selects(rule, i, j)) continue;
    weight = {rule.offset + rule.slope_i * i + rule.slope_j * j, rule.random,
              rule.redraw};
  }
  return weight;
}

}  // namespace

WeightTable::WeightTable(const Network& network, std::int64_t seed,
                         std::uint32_t stream, int columns, int rows,
                         bool transposed)
    : pairs_((columns + 1) / 2),
      desired_(network.desired),
      desired_random_(network.desired_random),
      desired_stream_(StreamKey(seed, stream * kStreamsPerNetwork)) {
  weights_.resize(static_cast<std::size_t>(2 * pairs_ * rows));
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      weights_[static_cast<std::size_t>(j * 2 * pairs_ + i)] =
          transposed ? InitialOf(network, 0, i) : InitialOf(network, i, j);
    }
  }
  const auto streams = static_cast<std::uint32_t>(pairs_ * rows);
  for (std::uint32_t k = 0; k < streams; ++k) {
    pair_streams_.push_back(
        StreamKey(seed, stream * kStreamsPerNetwork + 1 + k));
  }
}

double WeightTable::Initial(int i, int j, std::int64_t it,
                            std::int64_t iu) const {
  const InitialWeight& weight = At(i, j);
  if (weight.random == 0) return weight.base;
  const std::uint32_t bits = HashLane(ColumnWord(it), PairKey(i / 2, j, iu));
  const std::uint32_t half = i % 2 == 0 ? bits & 0xFFFFu : bits >> 16;
  return weight.base + weight.random * (half * kDrawUnit);
}

double WeightTable::Desired(std::int64_t it, std::int64_t iu) const {
  if (desired_random_ == 0) return desired_;
  const std::uint32_t bits = HashLane(ColumnWord(it), DesiredKey(iu));
  return desired_ + desired_random_ * ((bits & 0xFFFFu) * kDrawUnit);
}

}  // namespace terrane::core
