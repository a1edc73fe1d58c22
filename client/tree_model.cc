#include "client/tree_model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include "client/tree_rows.h"
#include "core/base/det_math.h"
#include "core/mesh/float3.h"
#include "core/mesh/leaf_mesh.h"

namespace terrane::client {
namespace {

constexpr char kBarkColor[] = "#665240";
constexpr char kLeafColor[] = "#55803a";
constexpr float kBarkRoughness = 0.95f;
constexpr float kLeafRoughness = 0.6f;
constexpr int kSides = 12;
// Of sRGB, close enough for the colour of a tree.
constexpr double kDisplayPower = 2.2;

absl::Status Bad(const std::string& field, const std::string& what) {
  return absl::InvalidArgumentError("view." + field + ": " + what);
}

// "#rrggbb" as linear light.
absl::StatusOr<std::array<float, 3>> ReadColor(const std::string& field,
                                               const std::string& text) {
  std::array<float, 3> color = {};
  bool good = text.size() == 7 && text[0] == '#';
  for (std::size_t k = 0; good && k < color.size(); ++k) {
    int value = 0;
    const char* const first = text.data() + 1 + 2 * k;
    const std::from_chars_result read =
        std::from_chars(first, first + 2, value, 16);
    good = read.ec == std::errc() && read.ptr == first + 2;
    color[k] = static_cast<float>(core::DetPow(value / 255.0, kDisplayPower));
  }
  if (!good) return Bad(field, "must be #rrggbb, got \"" + text + "\"");
  return color;
}

absl::StatusOr<core::LeafShape> ReadShape(const v1::TreeView& view) {
  core::LeafShape shape;
  if (view.leaf_width() != 0) shape.width = view.leaf_width();
  if (view.leaf_blades() != 0) shape.blades = view.leaf_blades();
  if (view.leaf_spread_deg() != 0) shape.spread_deg = view.leaf_spread_deg();
  if (!(shape.width > 0 && shape.width <= 2)) {
    return Bad("leaf_width",
               "must be in (0, 2], got " + std::to_string(shape.width));
  }
  if (shape.blades < 1 || shape.blades > 32) {
    return Bad("leaf_blades",
               "must be in [1, 32], got " + std::to_string(shape.blades));
  }
  if (!(shape.spread_deg > 0 && shape.spread_deg <= 360)) {
    return Bad("leaf_spread_deg",
               "must be in (0, 360], got " + std::to_string(shape.spread_deg));
  }
  return shape;
}

// One leaf in 2^level, and larger by as much as the crown would be emptier.
void ThinOut(int level, core::Instances* leaves) {
  if (level == 0) return;
  const std::size_t step = std::size_t{1} << level;
  const auto larger = static_cast<float>(std::sqrt(static_cast<double>(step)));
  std::size_t kept = 0;
  for (std::size_t k = 0; k < leaves->count(); k += step, ++kept) {
    leaves->translations[kept] = leaves->translations[k];
    leaves->rotations[kept] = leaves->rotations[k];
    leaves->scales[kept] = larger * leaves->scales[k];
  }
  leaves->translations.resize(kept);
  leaves->rotations.resize(kept);
  leaves->scales.resize(kept);
}

absl::Status StreamWood(const v1::TreeChoice& choice,
                        const v1::TubeOptions& tubes, ProgressMode mode,
                        TreeBackend* backend, std::stop_token stop,
                        TreeModel* model) {
  v1::StreamTreeMeshRequest request;
  *request.mutable_tree() = choice;
  *request.mutable_tubes() = tubes;
  std::unique_ptr<Progress> progress;
  return backend->StreamTreeMesh(
      request,
      [&](const v1::TreeHeader& header) {
        model->header = header;
        // How many vertices there will be is not known: some 20 a segment.
        progress = std::make_unique<Progress>(mode, 20 * header.segments_most(),
                                              "vertices");
        return absl::OkStatus();
      },
      [&](const v1::TubeBlock& block) {
        progress->Advance(block.vertices());
        return AppendTubes(block, &model->wood);
      },
      std::move(stop));
}

absl::Status StreamLeaves(const v1::TreeChoice& choice, TreeBackend* backend,
                          std::stop_token stop, TreeModel* model) {
  v1::StreamTreeLeavesRequest request;
  *request.mutable_tree() = choice;
  return backend->StreamTreeLeaves(
      request, [](const v1::TreeHeader&) { return absl::OkStatus(); },
      [&](const v1::LeafRows& leaves) {
        AppendLeaves(leaves, &model->leaves);
        return absl::OkStatus();
      },
      std::move(stop));
}

// The options of a level of detail.
absl::StatusOr<v1::TubeOptions> TubesOfLevel(const v1::TreeChoice& choice,
                                             const TreeModelOptions& options,
                                             TreeBackend* backend,
                                             std::stop_token stop) {
  v1::TubeOptions tubes = options.tubes;
  if (options.level == 0) return tubes;
  v1::EstimateTreeRequest ask;
  *ask.mutable_tree() = choice;
  const absl::StatusOr<v1::EstimateTreeResponse> estimate =
      backend->EstimateTree(ask, std::move(stop));
  if (!estimate.ok()) return estimate.status();
  const absl::StatusOr<int> last = LastGeneration(options.level, *estimate);
  if (!last.ok()) return last.status();
  tubes.set_last_generation(*last);
  const int sides = tubes.sides() == 0 ? kSides : tubes.sides();
  tubes.set_sides(std::max(sides / (options.level + 1), 3));
  if (tubes.least_sides() > tubes.sides()) tubes.set_least_sides(tubes.sides());
  return tubes;
}

core::Float3 Turned(const core::Quaternion& q, const core::Float3& v) {
  const core::Float3 axis = {q.x, q.y, q.z};
  const core::Float3 once = 2.0f * core::Cross(axis, v);
  return v + q.w * once + core::Cross(axis, once);
}

}  // namespace

absl::StatusOr<int> LastGeneration(int level,
                                   const v1::EstimateTreeResponse& estimate) {
  const int last = estimate.last_generation();
  if (level <= last) return last - level;
  return absl::InvalidArgumentError(
      "--lod: must be in [0, " + std::to_string(last) +
      "], the tree's generations, got " + std::to_string(level));
}

absl::StatusOr<TreeModel> StreamTreeModel(const v1::TreeRecipe& recipe,
                                          const TreeModelOptions& options,
                                          TreeBackend* backend,
                                          std::stop_token stop) {
  v1::TreeChoice choice;
  *choice.mutable_recipe() = recipe;
  const absl::StatusOr<v1::TubeOptions> tubes =
      TubesOfLevel(choice, options, backend, stop);
  if (!tubes.ok()) return tubes.status();
  TreeModel model;
  absl::Status status =
      StreamWood(choice, *tubes, options.progress, backend, stop, &model);
  if (status.ok() && options.leaves && recipe.has_leaves()) {
    status = StreamLeaves(choice, backend, std::move(stop), &model);
  }
  if (!status.ok()) return status;
  if (model.wood.indices.empty()) {
    return absl::InvalidArgumentError(
        "the tree has no thickness, so it has no mesh: a Cantor set can be "
        "written as .svg, .png, .swc and .csv");
  }
  ThinOut(options.level, &model.leaves);
  return model;
}

absl::StatusOr<TreeLook> TreeLook::Create(const v1::TreeView& view) {
  const auto color = [](const char* field, const std::string& text,
                        const char* otherwise) {
    return ReadColor(field, text.empty() ? otherwise : text);
  };
  const auto bark = color("bark_color", view.bark_color(), kBarkColor);
  if (!bark.ok()) return bark.status();
  const auto leaf = color("leaf_color", view.leaf_color(), kLeafColor);
  if (!leaf.ok()) return leaf.status();
  const absl::StatusOr<core::LeafShape> shape = ReadShape(view);
  if (!shape.ok()) return shape.status();
  TreeLook look;
  look.materials_ = {
      {.name = "bark", .base_color = *bark, .roughness = kBarkRoughness},
      {.name = "leaf",
       .base_color = *leaf,
       .roughness = kLeafRoughness,
       .double_sided = true}};
  look.leaf_ = core::MakeLeafMesh(*shape);
  return look;
}

core::Scene TreeLook::SceneOf(const TreeModel& model) const {
  core::Scene scene = {materials_, {{"wood", &model.wood, kBark}}};
  if (model.leaves.count() > 0) {
    scene.objects.push_back({"leaves", &leaf_, kLeaf, &model.leaves});
  }
  return scene;
}

core::Mesh MergedMesh(const core::Scene& scene) {
  core::Mesh merged;
  for (const core::SceneObject& object : scene.objects) {
    const auto& [red, green, blue] =
        scene.materials[object.material].base_color;
    const core::Mesh& mesh = *object.mesh;
    const std::size_t copies =
        object.instances == nullptr ? 1 : object.instances->count();
    for (std::size_t copy = 0; copy < copies; ++copy) {
      const auto first = static_cast<std::uint32_t>(merged.positions.size());
      for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
        core::Float3 p = mesh.positions[k];
        core::Float3 n = mesh.normals[k];
        if (object.instances != nullptr) {
          // Leaves and trees grow evenly in all directions.
          const core::Instances& places = *object.instances;
          p = places.translations[copy] +
              places.scales[copy].x * Turned(places.rotations[copy], p);
          n = Turned(places.rotations[copy], n);
        }
        merged.positions.push_back(p);
        merged.normals.push_back(n);
        merged.colors.push_back({red, green, blue});
      }
      for (const std::uint32_t index : mesh.indices) {
        merged.indices.push_back(first + index);
      }
    }
  }
  return merged;
}

}  // namespace terrane::client
