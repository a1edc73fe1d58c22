// The scene of a tree: its tubes as one mesh, its leaves as instances of one.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/mesh/float3.h"
#include "core/mesh/rotation.h"
#include "server/actor/scenes/scene_source.h"
#include "server/convert/render_convert.h"

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

// A pointed leaf of length 1 along y, its upper face to +z, folded along its
// midrib and hanging towards its tip.
core::Mesh LeafMesh() {
  struct Station {
    float y, half_width, z;
  };
  constexpr Station kStations[] = {{0, 0.02f, 0},         {0.2f, 0.17f, 0.015f},
                                   {0.45f, 0.24f, 0.02f}, {0.7f, 0.17f, 0},
                                   {0.9f, 0.06f, -0.04f}, {1, 0.004f, -0.07f}};
  constexpr float kFold = 0.22f;  // rise of the edge by its distance
  core::Mesh leaf;
  for (const Station& at : kStations) {
    for (const float side : {-1.0f, 0.0f, 1.0f}) {
      const float rise = side == 0 ? 0 : kFold * at.half_width;
      leaf.positions.push_back({side * at.half_width, at.y, at.z + rise});
      leaf.normals.push_back(core::Normalized({-0.7f * side * kFold, 0, 1}));
    }
  }
  const auto stations = static_cast<std::uint32_t>(std::size(kStations));
  for (std::uint32_t i = 0; i + 1 < stations; ++i) {
    for (const std::uint32_t left : {3 * i, 3 * i + 1}) {
      for (const std::uint32_t corner :
           {left, left + 1, left + 4, left, left + 4, left + 3}) {
        leaf.indices.push_back(corner);
      }
    }
  }
  return leaf;
}

// Appends the values of a bytes column.
template <typename Value>
void Append(const std::string& bytes, std::vector<Value>* column) {
  const std::size_t before = column->size();
  column->resize(before + bytes.size() / sizeof(Value));
  std::memcpy(column->data() + before, bytes.data(), bytes.size());
}

class TreeScene : public SceneSource {
 public:
  using Tubes = std::unique_ptr<MessageRun<v1::StreamTreeMeshResponse>>;
  using Leaves = std::unique_ptr<MessageRun<v1::StreamTreeLeavesResponse>>;

  // `leaves` is null for a tree without.
  TreeScene(Tubes tubes, Leaves leaves, const core::Material& bark,
            const core::Material& leaf, const Limits& limits)
      : tubes_(std::move(tubes)),
        leaves_(std::move(leaves)),
        bark_(bark),
        leaf_(leaf),
        limits_(limits),
        leaf_mesh_(LeafMesh()) {}

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
    Append(block.positions(), &wood_.positions);
    Append(block.normals(), &wood_.normals);
    Append(block.indices(), &wood_.indices);
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
    Append(rows.positions(), &places_.translations);
    Append(rows.directions(), &directions);
    Append(rows.normals(), &normals);
    Append(rows.sizes(), &sizes);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const core::Float3 across = core::Cross(directions[i], normals[i]);
      places_.rotations.push_back(
          core::RotationTo(across, directions[i], normals[i]));
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

struct TreeMaterials {
  core::Material bark;
  core::Material leaf;
};

TreeMaterials MaterialsOf(const v1::TreeSubject& subject,
                          const SceneRequest& request) {
  const std::string path = request.prefix + "tree.";
  return {ReadMaterial(subject.has_bark() ? &subject.bark() : nullptr,
                       UsualBark(), path + "bark.", request.violations),
          ReadMaterial(subject.has_leaf() ? &subject.leaf() : nullptr,
                       UsualLeaf(), path + "leaf.", request.violations)};
}

}  // namespace

OpenedScene OpenTreeScene(const v1::TreeSubject& subject,
                          const TreeMaker& trees, const SceneRequest& request) {
  const TreeMaterials materials = MaterialsOf(subject, request);
  const std::string path = request.prefix + "tree.";
  v1::StreamTreeMeshRequest tubes;
  *tubes.mutable_tree() = subject.tree();
  *tubes.mutable_tubes() = subject.tubes();
  auto tube_run = trees.OpenMesh(tubes);
  if (!tube_run.ok()) {
    const absl::Status moved =
        MoveViolations(tube_run.status(), "", path, request.violations);
    if (!moved.ok()) return moved;
    return std::unique_ptr<SceneSource>();
  }
  // Valid, as the tubes could be opened.
  const auto chosen =
      trees.Choose(subject.tree(), path + "tree", request.violations);
  if (!chosen.ok()) return chosen.status();
  TreeScene::Leaves leaf_run;
  if (chosen->tree->spec().leaves.has_value()) {
    v1::StreamTreeLeavesRequest leaves;
    *leaves.mutable_tree() = subject.tree();
    auto opened = trees.OpenLeaves(leaves);
    if (!opened.ok()) return opened.status();
    leaf_run = *std::move(opened);
  }
  return std::make_unique<TreeScene>(*std::move(tube_run), std::move(leaf_run),
                                     materials.bark, materials.leaf,
                                     request.limits);
}

EstimatedScene EstimateTreeScene(const v1::TreeSubject& subject,
                                 const TreeMaker& trees,
                                 const SceneRequest& request) {
  MaterialsOf(subject, request);
  v1::EstimateTreeRequest asked;
  *asked.mutable_tree() = subject.tree();
  const auto estimate = trees.Estimate(asked);
  if (!estimate.ok()) {
    const absl::Status moved = MoveViolations(
        estimate.status(), "", request.prefix + "tree.", request.violations);
    if (!moved.ok()) return moved;
    return core::SceneSize();
  }
  const std::int64_t sides =
      std::max<std::int64_t>(subject.tubes().sides(), kUsualSides);
  const std::int64_t triangles =
      kTrianglesOfRow * sides / kUsualSides * estimate->segments_most();
  return core::SceneSize{triangles, triangles, estimate->leaves_most()};
}

}  // namespace terrane::server
