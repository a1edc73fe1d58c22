// Skeletons of trees to CSV with the columns of TreeQSM's cylinder tables,
// which forest tools read, and a few more behind them.
//
//   radius, length, start_x, start_y, start_z, axis_x, axis_y, axis_z   of the
//     cylinder; radius is at its base, axis a unit vector
//   parent, extension     lines of the parent and of the cylinder that goes on
//     with the same branch, counted from 1; 0: none
//   branch, branch_order, position_in_branch   a branch is its pieces and
//     leaders; the trunk is branch 1 of order 0; positions count from 1
//   end_x, end_y, end_z, radius_end, attach, flags, chromosome   the row's own
// Numbers are the shortest that read back as the same float.
//
// Threads: any. The same rows give the same bytes.
#ifndef TERRANE_CORE_CODEC_TREE_CSV_H_
#define TERRANE_CORE_CODEC_TREE_CSV_H_

#include <cstdint>
#include <string>

#include "core/mesh/segment_block.h"

namespace terrane::core {

// `tree` holds all rows of a tree, from row 0 on.
std::string EncodeTreeCsv(const SegmentBlock& tree);

// A forest as one text: trees one after the other, with one more column, tree,
// that counts them from 0. Lines are counted through the whole text, branches
// from 1 in each tree. Belongs to one thread.
class TreeCsvForest {
 public:
  // The first line.
  static std::string Header();
  // The lines of the next tree.
  std::string Add(const SegmentBlock& tree);

 private:
  std::uint32_t lines_ = 0;
  std::uint32_t trees_ = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_TREE_CSV_H_
