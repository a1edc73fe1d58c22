// Skeletons of trees to SWC text, which tools of neuron and plant morphology
// read: a line a node, `id type x y z radius parent`.
//
// A row has a node at its start (type 5), one where each of its children joins
// it between its ends (type 7) and one at its end (type 6); a child's start
// node hangs on the node where it joins. So start, end, radii and parents of
// every row can be read back exactly: numbers are the shortest that read back
// as the same float.
//
// Threads: any. The same rows give the same bytes.
#ifndef TERRANE_CORE_CODEC_SWC_H_
#define TERRANE_CORE_CODEC_SWC_H_

#include <cstdint>
#include <string>

#include "core/mesh/segment_block.h"

namespace terrane::core {

inline constexpr int kSwcStart = 5;
inline constexpr int kSwcEnd = 6;
inline constexpr int kSwcJoint = 7;

// The z axis points up. `tree` holds all rows of a tree, from row 0 on.
std::string EncodeSwc(const SegmentBlock& tree);

// A forest as one text: trees one after the other, each with a root of its own,
// node ids going on from tree to tree. Belongs to one thread.
class SwcForest {
 public:
  // The first line.
  static std::string Header();
  // The lines of the next tree.
  std::string Add(const SegmentBlock& tree);

 private:
  std::int64_t nodes_ = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_SWC_H_
