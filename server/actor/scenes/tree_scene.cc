// The scene of a tree: its tubes as one mesh, its leaves as instances of one.
#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/column_bytes.h"
#include "core/base/field_checks.h"
#include "core/mesh/leaf_mesh.h"
#include "server/actor/scenes/scene_source.h"
#include "server/convert/non_zero.h"
#include "server/convert/render_convert.h"
#include "server/convert/tree_convert.h"

namespace terrane::server {
namespace {

core::Material UsualBark() {
  core::Material material;
  material.name = "bark";
  material.base_color = {0.23f, 0.15f, 0.09f};
  return material;
}

core::Material UsualLeaf() {
  core::Material material;
  material.name = "leaf";
  material.base_color = {0.16f, 0.34f, 0.06f};
  material.roughness = 0.6f;
  material.double_sided = true;
  return material;
}

class TreeScene : public SceneSource {
 public:
  using Tubes = std::unique_ptr<MessageRun<v1::StreamTreeMeshResponse>>;
  using Leaves = std::unique_ptr<MessageRun<v1::StreamTreeLeavesResponse>>;

  // `leaves` is null for a tree without.
  TreeScene(Tubes tubes, Leaves leaves, const core::Material& bark,
            const core::Material& leaf, const core::LeafShape& shape,
            const Limits& limits)
      : tubes_(std::move(tubes)),
        leaves_(std::move(leaves)),
        bark_(bark),
        leaf_(leaf),
        limits_(limits),
        leaf_mesh_(core::MakeLeafMesh(shape)) {}

  const std::string& recipe_hash() const override {
    return tubes_->recipe_hash();
  }

  absl::Status Advance(std::stop_token stop) override {
    ++parts_;
    const absl::Status made =
        tubes_->Done() ? AddLeaves(std::move(stop)) : AddTubes(std::move(stop));
    if (!made.ok()) return made;
    return CheckTriangles(
        static_cast<std::int64_t>(wood_.indices.size() / 3 + places_.count()),
        limits_);
  }

  // How many parts there are shows at the end only.
  double share() const override {
    return Ready() ? 1 : 1 - 1 / (1 + 0.1 * static_cast<double>(parts_));
  }
  bool Ready() const override {
    return tubes_->Done() && (leaves_ == nullptr || leaves_->Done());
  }

  core::Scene scene() const override {
    core::Scene scene = {{bark_, leaf_}, {{"wood", &wood_, 0, nullptr}}};
    if (places_.count() > 0) {
      scene.objects.push_back({"leaves", &leaf_mesh_, 1, &places_});
    }
    return scene;
  }

 private:
  absl::Status AddTubes(std::stop_token stop) {
    const absl::Status made = tubes_->Next(std::move(stop), &tube_message_);
    if (!made.ok() || !tube_message_.has_block()) return made;
    const v1::TubeBlock& block = tube_message_.block();
    const auto first = static_cast<std::uint32_t>(wood_.positions.size());
    const std::size_t indices = wood_.indices.size();
    core::AppendColumn(block.positions(), &wood_.positions);
    core::AppendColumn(block.normals(), &wood_.normals);
    core::AppendColumn(block.indices(), &wood_.indices);
    for (std::size_t i = indices; i < wood_.indices.size(); ++i) {
      wood_.indices[i] += first;
    }
    return made;
  }

  absl::Status AddLeaves(std::stop_token stop) {
    const absl::Status made = leaves_->Next(std::move(stop), &leaf_message_);
    if (!made.ok() || !leaf_message_.has_leaves()) return made;
    const v1::LeafRows& rows = leaf_message_.leaves();
    std::vector<core::Float3> directions;
    std::vector<core::Float3> normals;
    std::vector<float> sizes;
    core::AppendColumn(rows.positions(), &places_.translations);
    core::AppendColumn(rows.directions(), &directions);
    core::AppendColumn(rows.normals(), &normals);
    core::AppendColumn(rows.sizes(), &sizes);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      places_.rotations.push_back(
          core::LeafRotation(directions[i], normals[i]));
      places_.scales.push_back({sizes[i], sizes[i], sizes[i]});
    }
    return made;
  }

  const Tubes tubes_;
  const Leaves leaves_;
  const core::Material bark_;
  const core::Material leaf_;
  const Limits limits_;
  const core::Mesh leaf_mesh_;
  std::int64_t parts_ = 0;
  v1::StreamTreeMeshResponse tube_message_;
  v1::StreamTreeLeavesResponse leaf_message_;
  core::Mesh wood_;
  core::Instances places_;
};

// Of a row with the default tubes, its dome included; more faces, more of them.
constexpr std::int64_t kTrianglesOfRow = 96;
constexpr std::int64_t kUsualSides = 12;

struct TreeLook {
  core::Material bark;
  core::Material leaf;
  core::LeafShape shape;
};

core::LeafShape ReadLeafShape(const v1::LeafShape& message,
                              const std::string& prefix,
                              core::Violations* violations) {
  core::LeafShape shape;
  ReadNonZero(message.width(), &shape.width);
  ReadNonZero(message.blades(), &shape.blades);
  ReadNonZero(message.spread_deg(), &shape.spread_deg);
  core::FieldChecks checks(violations);
  const core::Path root(&prefix);
  checks.Number(root.Field("width"), shape.width, {0, 2, true, false});
  checks.Integer(root.Field("blades"), shape.blades, 1, 32);
  checks.Number(root.Field("spread_deg"), shape.spread_deg,
                {0, 360, true, false});
  return shape;
}

TreeLook LookOf(const v1::TreeSubject& subject, const SceneRequest& request) {
  const std::string path = request.prefix + "tree.";
  return {ReadMaterial(subject.has_bark() ? &subject.bark() : nullptr,
                       UsualBark(), path + "bark.", request.violations),
          ReadMaterial(subject.has_leaf() ? &subject.leaf() : nullptr,
                       UsualLeaf(), path + "leaf.", request.violations),
          ReadLeafShape(subject.leaf_shape(), path + "leaf_shape.",
                        request.violations)};
}

}  // namespace

OpenedScene OpenTreeScene(const v1::TreeSubject& subject,
                          const TreeMaker& trees, const SceneRequest& request) {
  const TreeLook look = LookOf(subject, request);
  const std::string path = request.prefix + "tree.";
  v1::StreamTreeMeshRequest tubes;
  *tubes.mutable_tree() = subject.tree();
  *tubes.mutable_tubes() = subject.tubes();
  auto tube_run = trees.OpenMesh(tubes);
  if (!tube_run.ok()) {
    const absl::Status moved =
        MoveViolations(tube_run.status(), "", path, request.violations);
    if (!moved.ok()) return moved;
  }
  if (!request.violations->empty()) return std::unique_ptr<SceneSource>();
  // Valid, as the tubes could be opened.
  const ChosenTree chosen =
      trees.Choose(subject.tree(), path + "tree", request.violations);
  TreeScene::Leaves leaf_run;
  if (chosen.tree->spec().leaves.has_value()) {
    v1::StreamTreeLeavesRequest leaves;
    *leaves.mutable_tree() = subject.tree();
    auto opened = trees.OpenLeaves(leaves);
    if (!opened.ok()) return opened.status();
    leaf_run = *std::move(opened);
  }
  return std::make_unique<TreeScene>(*std::move(tube_run), std::move(leaf_run),
                                     look.bark, look.leaf, look.shape,
                                     request.limits);
}

EstimatedScene EstimateTreeScene(const v1::TreeSubject& subject,
                                 const TreeMaker& trees,
                                 const SceneRequest& request) {
  LookOf(subject, request);
  const core::TubeSpec tubes = ReadTubeOptions(
      subject.tubes(), request.prefix + "tree.tubes.", request.violations);
  v1::EstimateTreeRequest asked;
  *asked.mutable_tree() = subject.tree();
  const auto estimate = trees.Estimate(asked);
  if (!estimate.ok()) {
    const absl::Status moved = MoveViolations(
        estimate.status(), "", request.prefix + "tree.", request.violations);
    if (!moved.ok()) return moved;
    return core::SceneSize();
  }
  const std::int64_t sides = std::max<std::int64_t>(tubes.sides, kUsualSides);
  const std::int64_t triangles =
      kTrianglesOfRow * sides / kUsualSides * estimate->segments_most();
  return core::SceneSize{triangles, triangles, estimate->leaves_most()};
}

}  // namespace terrane::server
