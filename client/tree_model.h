// TreeModel: a tree as a scene: its wood as tubes, its leaves as instances.
//
// Streamed once from a backend and kept in memory: about 40 bytes a vertex of
// the wood and 40 a leaf. Belongs to one thread.
#ifndef TERRANE_CLIENT_TREE_MODEL_H_
#define TERRANE_CLIENT_TREE_MODEL_H_

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/chosen_tree.h"
#include "client/progress.h"
#include "client/tree_backend.h"
#include "core/mesh/scene.h"

namespace terrane::client {

// How a tree is modelled.
struct TreeModelOptions {
  // sides, least_sides and ends count; generations are left out by `level`.
  v1::TubeOptions tubes;
  bool leaves = true;  // where the recipe has them
  // Of detail: as many of the last generations are left out, the tubes have
  // 1 / (level + 1) of the faces around, and one leaf in 2^level is there,
  // 2^(level / 2) times as large. 0: everything.
  int level = 0;
  ProgressMode progress = ProgressMode::kAuto;
};

// The last generation of a level of detail of a tree: `level` before its own.
// Errors: INVALID_ARGUMENT when that leaves nothing.
absl::StatusOr<int> LastGeneration(int level,
                                   const v1::EstimateTreeResponse& estimate);

struct TreeModel {
  v1::TreeHeader header;
  core::Mesh wood;
  core::Instances leaves;
};

// Errors: those of the backend; INVALID_ARGUMENT when `level` leaves nothing,
// or for a tree that has no wood: a Cantor set.
absl::StatusOr<TreeModel> StreamTreeModel(const v1::TreeRecipe& recipe,
                                          const TreeModelOptions& options,
                                          TreeBackend* backend,
                                          std::stop_token stop);

// What the models of one recipe have in common: materials and a leaf's mesh.
class TreeLook {
 public:
  // Errors: INVALID_ARGUMENT naming the field of the view that is not well.
  static absl::StatusOr<TreeLook> Create(const v1::TreeView& view);

  // Refers to the model and to this.
  core::Scene SceneOf(const TreeModel& model) const;
  const core::Mesh& leaf() const { return leaf_; }
  const std::vector<core::Material>& materials() const { return materials_; }

  static constexpr std::size_t kBark = 0;
  static constexpr std::size_t kLeaf = 1;

 private:
  TreeLook() = default;

  std::vector<core::Material> materials_;
  core::Mesh leaf_;
};

// One mesh of a whole scene, instances written out, coloured by the materials:
// for pictures.
core::Mesh MergedMesh(const core::Scene& scene);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TREE_MODEL_H_
