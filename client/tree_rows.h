// Rows, leaves and tubes of a tree from messages back to columns.
//
// The messages come verified (client/tree_verifiers.h): their columns have the
// sizes that they must have. Threads: pure functions of what they are given.
#ifndef TERRANE_CLIENT_TREE_ROWS_H_
#define TERRANE_CLIENT_TREE_ROWS_H_

#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/progress.h"
#include "client/tree_backend.h"
#include "core/mesh/mesh.h"
#include "core/mesh/scene.h"
#include "core/mesh/segment_block.h"

namespace terrane::client {

// Appends a block behind the rows that are there.
void AppendRows(const v1::SegmentRows& rows, core::SegmentBlock* tree);

// Appends tubes. Errors: RESOURCE_EXHAUSTED beyond the vertices that a mesh can
// number.
absl::Status AppendTubes(const v1::TubeBlock& block, core::Mesh* mesh);

// Appends leaves as instances of a leaf's mesh (core/mesh/leaf_mesh.h).
void AppendLeaves(const v1::LeafRows& leaves, core::Instances* instances);

// All rows of a tree in memory, and the header that announced them.
struct StreamedTree {
  v1::TreeHeader header;
  core::SegmentBlock rows;
};
absl::StatusOr<StreamedTree> StreamWholeTree(const v1::TreeRecipe& recipe,
                                             ProgressMode progress,
                                             TreeBackend* backend,
                                             std::stop_token stop);

// Moves a tree to its place in a forest: scaled, turned about z, moved.
void PlaceTree(const v1::TreePlacement& placement, core::SegmentBlock* tree);

// A placement's scale; 0 means 1.
double ScaleOf(const v1::TreePlacement& placement);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TREE_ROWS_H_
