// Forests: many trees of one recipe, each with a seed and a place of its own.
//
// Threads: belongs to one. Errors: those of the backend and of the files.
#ifndef TERRANE_CLIENT_FOREST_H_
#define TERRANE_CLIENT_FOREST_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/tree_backend.h"
#include "client/tree_model.h"
#include "core/mesh/scene.h"
#include "core/mesh/segment_block.h"

namespace terrane::client {

// Either a range of seeds or a table of placements.
struct ForestOptions {
  std::int64_t count = 0;
  std::int64_t first_seed = 1;
  // Trees of a range stand on a square grid, row by row, this far apart.
  // Default: three times as far as the trunk is long.
  std::optional<double> spacing;
  // CSV with columns x and y and, if they are there, z, seed, scale and
  // yaw_deg; without seeds they are first_seed and on.
  std::string placements_file;
};

class Forest {
 public:
  // Reads the table. Errors: INVALID_ARGUMENT for none or both of the two, or a
  // seed that is not whole; an unreadable file.
  static absl::StatusOr<Forest> Create(const ForestOptions& options);

  std::int64_t count() const;
  // Of tree `index` of a recipe.
  v1::TreePlacement At(std::int64_t index,
                       const v1::TreeRecipe& resolved) const;
  // The batch call for all of them.
  v1::StreamForestRequest Request(const v1::TreeRecipe& recipe) const;

 private:
  explicit Forest(const ForestOptions& options) : options_(options) {}

  ForestOptions options_;
  std::vector<v1::TreePlacement> placements_;  // of a table
};

// Takes the trees of a forest, one after the other, in their places.
using OnTree = std::function<absl::Status(const core::SegmentBlock&)>;

// Streams a forest through the batch call, one tree in memory at a time.
struct ForestStream {
  v1::TreeHeader header;
  std::int64_t trees = 0;
  std::int64_t rows = 0;
};
absl::StatusOr<ForestStream> StreamForestTrees(
    const Forest& forest, const v1::TreeRecipe& recipe, ProgressMode progress,
    const OnTree& on_tree, TreeBackend* backend, std::stop_token stop);

// A forest as a scene: a mesh for each seed, instances of it where it stands,
// and all leaves as instances of one. Owns what the scene refers to.
class ForestModel {
 public:
  static absl::StatusOr<ForestModel> Stream(const Forest& forest,
                                            const v1::TreeRecipe& recipe,
                                            const TreeModelOptions& options,
                                            TreeBackend* backend,
                                            std::stop_token stop);

  core::Scene SceneOf(const TreeLook& look) const;
  // Of the first tree.
  const v1::TreeHeader& header() const { return header_; }
  const core::Instances& leaves() const { return leaves_; }

 private:
  // The trees of one seed.
  struct Stand {
    std::string name;
    core::Mesh wood;
    core::Instances places;
  };

  void AddTree(const v1::TreePlacement& placement,
               const core::Instances& leaves, Stand* stand);

  v1::TreeHeader header_;
  std::vector<std::unique_ptr<Stand>> stands_;
  core::Instances leaves_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_FOREST_H_
