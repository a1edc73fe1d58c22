// A picture of a flat tree: its rows as they lie in the plane y = 0, each as
// wide as it is thick.
//
// Pictures are pure functions of what is drawn. Threads: any.
#ifndef TERRANE_CLIENT_RENDER_SKELETON_VIEW_H_
#define TERRANE_CLIENT_RENDER_SKELETON_VIEW_H_

#include "client/render/canvas.h"
#include "core/mesh/segment_block.h"

namespace terrane::client {

// A square picture of `size` pixels a side; `tree` has a row at least. A row is
// drawn at least three quarters of a pixel wide.
Picture DrawSkeleton(const core::SegmentBlock& tree, int size,
                     const Rgb& colour);

// Lays the generations of a Cantor set, which all lie on one line, below each
// other as bars, for pictures.
void SpreadGenerations(core::SegmentBlock* set);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_SKELETON_VIEW_H_
