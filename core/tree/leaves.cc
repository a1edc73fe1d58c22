#include "core/tree/leaves.h"

#include "core/mesh/float3.h"
#include "core/noise/counter_hash.h"
#include "core/tree/draws.h"
#include "core/tree/pieces.h"
#include "core/tree/turn_table.h"

namespace terrane::core {
namespace {

constexpr std::uint32_t kHalfTurn = 1u << 31;

// The leaves of one tree, tip by tip.
class LeafPlacer {
 public:
  LeafPlacer(const TreeSpec& spec, LeafBlock* leaves)
      : leaves_(*leaves),
        spec_(*spec.leaves),
        is_flat_(spec.dimensions == 2),
        length_of_piece_(static_cast<float>(spec.bending.pieces)),
        stream_(StreamKey(spec.seed, kLeafStream)),
        deviation_(SineCosineOfDegrees(spec_.angle_deg)) {}

  // A tip from `start` to `end`.
  void Place(std::int64_t row, Float3 start, Float3 end) {
    const Float3 along = end - start;
    const float length = Length(along);
    if (!(length > 0)) return;
    const Float3 direction = (1.0f / length) * along;
    const Pose pose = {direction, Perpendicular(direction)};
    const RowKey key = MakeRowKey(stream_, row);
    const std::uint32_t phase = is_flat_ ? 0 : HashLane(ColumnWord(0), key);
    const std::uint32_t step = is_flat_ ? kHalfTurn : kGoldenTurn;
    for (int i = 0; i < spec_.count; ++i) {
      const auto leaf = static_cast<std::uint32_t>(i);
      const float share =
          static_cast<float>(i + 1) / static_cast<float>(spec_.count);
      const Pose turned =
          Deviate(pose, deviation_, turns_.Of(phase + step * leaf));
      leaves_.row.push_back(static_cast<std::uint32_t>(row));
      leaves_.position.push_back(start + share * along);
      leaves_.direction.push_back(turned.direction);
      leaves_.normal.push_back(UpperFace(turned.direction));
      leaves_.size.push_back(SizeOf(length * length_of_piece_, i, key));
    }
  }

 private:
  // Up as far as the direction lets it; a leaf of a flat tree faces the viewer.
  Float3 UpperFace(Float3 direction) const {
    if (is_flat_) return {0, -1, 0};
    const Float3 up = Float3{0, 0, 1} - direction.z * direction;
    return Dot(up, up) > 1e-6f ? Normalized(up) : Perpendicular(direction);
  }

  float SizeOf(float tip_length, int leaf, RowKey key) const {
    const std::uint32_t sum = DrawSum(HashLane(ColumnWord(2 * leaf + 1), key),
                                      HashLane(ColumnWord(2 * leaf + 2), key));
    // Y(1) of the paper: in [-1, 1], close to normal.
    const float chance =
        2.0f * static_cast<float>(sum) / static_cast<float>(kDrawSumMax) - 1.0f;
    const float mean = spec_.size > 0
                           ? static_cast<float>(spec_.size)
                           : tip_length * static_cast<float>(spec_.size_share);
    return mean * (1.0f + static_cast<float>(spec_.size_variation) * chance);
  }

  LeafBlock& leaves_;
  const LeafSpec& spec_;
  const bool is_flat_;
  const float length_of_piece_;
  const std::uint64_t stream_;
  const SineCosine deviation_;
  const TurnTable turns_;
};

}  // namespace

absl::Status PlaceLeaves(const TreeSpec& spec, const SegmentBlock& block,
                         std::stop_token stop, LeafBlock* leaves) {
  leaves->row.clear();
  leaves->position.clear();
  leaves->direction.clear();
  leaves->normal.clear();
  leaves->size.clear();
  LeafPlacer placer(spec, leaves);
  GenerationWalk generations(block);
  for (std::size_t i = 0; i < block.rows(); ++i) {
    const int generation = generations.At(i);
    const std::uint8_t flags = block.flags[i];
    const bool bears = generation > spec.depth - spec.leaves->generations ||
                       (flags & kTerminalFlag) != 0;
    const bool is_last_piece = (flags & kContinuedFlag) == 0;
    if (!bears || !(is_last_piece || spec.leaves->every_piece)) continue;
    if (stop.stop_requested()) {
      return absl::CancelledError("placing of leaves stopped");
    }
    placer.Place(block.first_row + static_cast<std::int64_t>(i), block.start[i],
                 block.end[i]);
  }
  return absl::OkStatus();
}

}  // namespace terrane::core
