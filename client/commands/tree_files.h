// The files that `terrane tree` writes: pictures, meshes and tables of a tree,
// or of a forest.
#ifndef TERRANE_CLIENT_COMMANDS_TREE_FILES_H_
#define TERRANE_CLIENT_COMMANDS_TREE_FILES_H_

#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/chosen_tree.h"
#include "client/forest.h"
#include "client/report.pb.h"
#include "client/tree_backend.h"
#include "client/tree_model.h"
#include "core/codec/gltf.h"

namespace terrane::client {

enum class TreeFormat { kSvg, kPng, kGlb, kObj, kSwc, kCsv };

// By extension. Errors: INVALID_ARGUMENT with the list of those that there are.
absl::StatusOr<TreeFormat> TreeFormatOf(const std::string& path);

struct TreeFileOptions {
  std::string out;
  // Levels of detail; one, but for GLB files.
  std::vector<int> levels = {0};
  TreeModelOptions model;  // its level is not used
  core::GltfInstancing instancing = core::GltfInstancing::kExtension;
  double metres_per_unit = 1;
  int picture_size = 900;  // pixels a side
};

// Generates a tree and writes it.
absl::Status WriteTree(const ChosenTree& tree, const TreeFileOptions& options,
                       TreeBackend* backend, std::stop_token stop,
                       TreeSummary* summary);

// The same of a forest, as GLB, SWC or CSV; the tables one tree at a time.
absl::Status WriteForest(const ChosenTree& tree, const Forest& forest,
                         const TreeFileOptions& options, TreeBackend* backend,
                         std::stop_token stop, TreeSummary* summary);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_COMMANDS_TREE_FILES_H_
