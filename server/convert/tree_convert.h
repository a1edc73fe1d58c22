// A tree between the API and the core, both ways.
//
// As surface_convert.h: every violation is collected, by its path in the
// request, and writing what was read gives a recipe in which every field that
// counts says what it means. Columns are copied as they lie in memory. Threads:
// any.
#ifndef TERRANE_SERVER_CONVERT_TREE_CONVERT_H_
#define TERRANE_SERVER_CONVERT_TREE_CONVERT_H_

#include <cstdint>
#include <string>

#include "core/base/violations.h"
#include "core/mesh/mesh.h"
#include "core/mesh/segment_block.h"
#include "core/tree/leaves.h"
#include "core/tree/tree_mesh.h"
#include "core/tree/tree_spec.h"
#include "core/tree/validate.h"
#include "terrane/v1/tree.pb.h"
#include "terrane/v1/tree_recipe.pb.h"

namespace terrane::server {

// Converts and checks (core::ValidateTreeSpec) a recipe. `prefix` stands before
// the path of each field, such as "tree.recipe.".
core::TreeSpec ReadTreeRecipe(const v1::TreeRecipe& recipe,
                              const core::TreeLimits& limits,
                              const std::string& prefix,
                              core::Violations* violations);

// The recipe of the spec of a Tree, with every default filled in.
v1::TreeRecipe WriteTreeRecipe(const core::TreeSpec& spec);

// Converts and checks (core::ValidateTubeSpec) what tubes are asked for.
core::TubeSpec ReadTubeOptions(const v1::TubeOptions& options,
                               const std::string& prefix,
                               core::Violations* violations);

// Blocks to messages, checksum included. They replace what the message holds.
void WriteSegments(const core::SegmentBlock& block, v1::SegmentRows* rows);
void WriteTubes(const core::Mesh& mesh, std::int64_t index,
                v1::TubeBlock* block);
void WriteLeaves(const core::LeafBlock& block, std::int64_t first_leaf,
                 v1::LeafRows* rows);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_TREE_CONVERT_H_
