// Skeletons of trees to SVG: a line with round ends for each row, a group for
// each generation, seen along y.
//
// Threads: any. The same rows give the same bytes; numbers are the shortest
// that read back as the same float.
#ifndef TERRANE_CORE_CODEC_SVG_H_
#define TERRANE_CORE_CODEC_SVG_H_

#include <string>

#include "core/mesh/segment_block.h"

namespace terrane::core {

// `tree` holds all rows of a tree, from row 0 on. Lines are as wide as the rows
// in their middle, and at least a thousandth of the picture, so that a segment
// without a radius is seen. `colour` is a CSS colour.
std::string EncodeTreeSvg(const SegmentBlock& tree, const std::string& colour);

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_SVG_H_
