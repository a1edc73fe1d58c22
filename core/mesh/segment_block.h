// SegmentBlock: rows of a tree's skeleton as columns, a run of the stream.
//
// Shared by the generator that makes them and the codecs that write them.
// A row is a segment: one branch, or one piece of a branch that bends. Rows
// come breadth-first, so a parent's index is below its children's and a
// generation is a range of rows; a mark closes each generation. Every prefix of
// the rows is a tree. Columns are little-endian bytes on the wire:
//   parent u32 | start 3 f32 | end 3 f32 | radius start f32 | radius end f32 |
//   flags u8 | attach f32 | chromosome u32 | extension u32 (3-D only)
// Lengths are in the spec's unit, z is up. Plain data; belongs to one thread.
#ifndef TERRANE_CORE_MESH_SEGMENT_BLOCK_H_
#define TERRANE_CORE_MESH_SEGMENT_BLOCK_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace terrane::core {

// The trunk's parent.
inline constexpr std::uint32_t kNoParent = 0xFFFFFFFFu;

// Bits of the flags.
inline constexpr std::uint8_t kMonopodialFlag = 1;
inline constexpr std::uint8_t kLeftFlag = 2;
// The branch has no children, however deep the tree is grown.
inline constexpr std::uint8_t kTerminalFlag = 4;
// The next row goes on with the same branch, as its next piece.
inline constexpr std::uint8_t kContinuedFlag = 8;
// The branch goes on straight from the tip of its monopodial parent.
inline constexpr std::uint8_t kLeaderFlag = 16;

// The end of a generation: one past its last row.
struct GenerationMark {
  int generation = 0;
  std::int64_t end_row = 0;

  bool operator==(const GenerationMark&) const = default;
};

struct SegmentBlock {
  // Of the first row: its index and its generation.
  std::int64_t first_row = 0;
  int first_generation = 0;

  std::vector<std::uint32_t> parent;
  std::vector<Float3> start;
  std::vector<Float3> end;
  std::vector<float> radius_start;
  std::vector<float> radius_end;
  std::vector<std::uint8_t> flags;
  // Where the row begins along its parent's row, 0 at the base, 1 at the tip.
  std::vector<float> attach;
  // 0 where there are no genes: plain trees and strict Cantor sets.
  std::vector<std::uint32_t> chromosome;
  // The azimuth about the parent's direction, 2^32 to a turn. Empty in 2-D.
  std::vector<std::uint32_t> extension;

  // Generations that end in this block, at its rows' indices.
  std::vector<GenerationMark> marks;

  std::size_t rows() const { return parent.size(); }
};

// The generations of a block's rows, one after the other.
class GenerationWalk {
 public:
  explicit GenerationWalk(const SegmentBlock& block)
      : block_(block), generation_(block.first_generation) {}

  // Of the row with this index in the block; indices do not fall from call to
  // call.
  int At(std::size_t index) {
    const auto row = block_.first_row + static_cast<std::int64_t>(index);
    while (next_ < block_.marks.size() && row >= block_.marks[next_].end_row) {
      generation_ = block_.marks[next_++].generation + 1;
    }
    return generation_;
  }

 private:
  const SegmentBlock& block_;
  int generation_;
  std::size_t next_ = 0;
};

// Bytes of a row in all columns.
constexpr std::int64_t SegmentBytes(int dimensions) {
  return dimensions == 3 ? 49 : 45;
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_MESH_SEGMENT_BLOCK_H_
