#include "client/forest.h"

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <utility>

#include "client/csv.h"
#include "client/tree_rows.h"
#include "core/mesh/float3.h"

namespace terrane::client {
namespace {

constexpr double kSpacingOfTrunk = 3;

// Whole numbers up to here are exact in the table's doubles.
constexpr double kLargestSeed = 9007199254740992.0;

// Vertices of all meshes: a GLB holds 4 GiB.
constexpr std::size_t kMostVertices = 100'000'000;

absl::StatusOr<std::vector<v1::TreePlacement>> ReadPlacements(
    const std::string& path, std::int64_t first_seed) {
  std::ifstream file(path);
  if (!file) return absl::NotFoundError("cannot read " + path);
  const auto table = ReadCsvColumns(&file, path,
                                    {{{"x"}, true},
                                     {{"y"}, true},
                                     {{"z"}, false},
                                     {{"seed"}, false},
                                     {{"scale"}, false},
                                     {{"yaw_deg", "yaw"}, false}});
  if (!table.ok()) return table.status();
  const auto& columns = table->columns;
  std::vector<v1::TreePlacement> placements(table->lines.size());
  for (std::size_t k = 0; k < placements.size(); ++k) {
    v1::TreePlacement& placement = placements[k];
    placement.set_x(columns[0][k]);
    placement.set_y(columns[1][k]);
    if (!columns[2].empty()) placement.set_z(columns[2][k]);
    placement.set_seed(first_seed + static_cast<std::int64_t>(k));
    if (!columns[3].empty()) {
      const double seed = columns[3][k];
      if (seed != std::floor(seed) || std::fabs(seed) > kLargestSeed) {
        return absl::InvalidArgumentError(
            path + " line " + std::to_string(table->lines[k]) +
            ": seed must be a whole number within 2^53, got " +
            std::to_string(seed));
      }
      placement.set_seed(static_cast<std::int64_t>(seed));
    }
    if (!columns[4].empty()) placement.set_scale(columns[4][k]);
    if (!columns[5].empty()) placement.set_yaw_deg(columns[5][k]);
  }
  return placements;
}

core::Quaternion Yaw(const v1::TreePlacement& placement) {
  const double half = placement.yaw_deg() * std::numbers::pi / 360;
  return {0, 0, static_cast<float>(std::sin(half)),
          static_cast<float>(std::cos(half))};
}

// `yaw` after `q`.
core::Quaternion Turned(const core::Quaternion& yaw,
                        const core::Quaternion& q) {
  return {yaw.w * q.x - yaw.z * q.y, yaw.w * q.y + yaw.z * q.x,
          yaw.w * q.z + yaw.z * q.w, yaw.w * q.w - yaw.z * q.z};
}

}  // namespace

absl::StatusOr<Forest> Forest::Create(const ForestOptions& options) {
  if ((options.count > 0) == !options.placements_file.empty()) {
    return absl::InvalidArgumentError(
        "a forest needs one of --count and --placements");
  }
  Forest forest(options);
  if (!options.placements_file.empty()) {
    auto placements =
        ReadPlacements(options.placements_file, options.first_seed);
    if (!placements.ok()) return placements.status();
    forest.placements_ = std::move(*placements);
  }
  return forest;
}

std::int64_t Forest::count() const {
  return placements_.empty() ? options_.count
                             : static_cast<std::int64_t>(placements_.size());
}

v1::TreePlacement Forest::At(std::int64_t index,
                             const v1::TreeRecipe& resolved) const {
  if (!placements_.empty()) {
    return placements_[static_cast<std::size_t>(index)];
  }
  const auto columns = static_cast<std::int64_t>(
      std::ceil(std::sqrt(static_cast<double>(options_.count))));
  const double spacing =
      options_.spacing.value_or(kSpacingOfTrunk * resolved.trunk_length());
  v1::TreePlacement placement;
  placement.set_seed(options_.first_seed + index);
  placement.set_x(spacing * static_cast<double>(index % columns));
  placement.set_y(spacing * static_cast<double>(index / columns));
  return placement;
}

v1::StreamForestRequest Forest::Request(const v1::TreeRecipe& recipe) const {
  v1::StreamForestRequest request;
  *request.mutable_tree()->mutable_recipe() = recipe;
  if (placements_.empty()) {
    request.mutable_seeds()->set_first_seed(options_.first_seed);
    request.mutable_seeds()->set_count(options_.count);
  } else {
    *request.mutable_placements()->mutable_placements() = {placements_.begin(),
                                                           placements_.end()};
  }
  return request;
}

absl::StatusOr<ForestStream> StreamForestTrees(
    const Forest& forest, const v1::TreeRecipe& recipe, ProgressMode progress,
    const OnTree& on_tree, TreeBackend* backend, std::stop_token stop) {
  ForestStream stream;
  core::SegmentBlock tree;
  Progress shown(progress, forest.count(), "trees");
  const absl::Status status = backend->StreamForest(
      forest.Request(recipe),
      [&](const v1::TreeHeader& header) {
        stream.header = header;
        return absl::OkStatus();
      },
      [&](const v1::ForestBlock& block) {
        AppendRows(block.segments(), &tree);
        if (!block.ends_tree()) return absl::OkStatus();
        PlaceTree(forest.At(block.tree(), stream.header.recipe()), &tree);
        const absl::Status taken = on_tree(tree);
        ++stream.trees;
        stream.rows += static_cast<std::int64_t>(tree.rows());
        tree = {};
        shown.Advance(1);
        return taken;
      },
      std::move(stop));
  if (!status.ok()) return status;
  return stream;
}

absl::StatusOr<ForestModel> ForestModel::Stream(const Forest& forest,
                                                const v1::TreeRecipe& recipe,
                                                const TreeModelOptions& options,
                                                TreeBackend* backend,
                                                std::stop_token stop) {
  ForestModel model;
  Progress progress(options.progress, forest.count(), "trees");
  TreeModelOptions of_one = options;
  of_one.progress = ProgressMode::kNone;
  v1::TreeRecipe one = recipe;
  // A seed that stands in several places is grown once.
  std::map<std::int64_t, std::pair<Stand*, core::Instances>> grown;
  std::size_t vertices = 0;
  for (std::int64_t index = 0; index < forest.count(); ++index) {
    // The spacing follows from the resolved recipe, which the first tree names.
    const std::int64_t seed = forest.At(index, model.header_.recipe()).seed();
    auto found = grown.find(seed);
    if (found == grown.end()) {
      one.set_seed(seed);
      absl::StatusOr<TreeModel> tree =
          StreamTreeModel(one, of_one, backend, stop);
      if (!tree.ok()) return tree.status();
      if (index == 0) model.header_ = tree->header;
      vertices += tree->wood.positions.size();
      if (vertices > kMostVertices) {
        return absl::ResourceExhaustedError(
            "a forest in one file has at most " +
            std::to_string(kMostVertices) +
            " vertices; leave generations out with --lod or --depth");
      }
      model.stands_.push_back(std::make_unique<Stand>());
      Stand* const stand = model.stands_.back().get();
      stand->name = "wood " + std::to_string(seed);
      stand->wood = std::move(tree->wood);
      found =
          grown.emplace(seed, std::pair(stand, std::move(tree->leaves))).first;
    }
    model.AddTree(forest.At(index, model.header_.recipe()),
                  found->second.second, found->second.first);
    progress.Advance(1);
  }
  return model;
}

void ForestModel::AddTree(const v1::TreePlacement& placement,
                          const core::Instances& leaves, Stand* stand) {
  const core::Quaternion yaw = Yaw(placement);
  const auto scale = static_cast<float>(ScaleOf(placement));
  const core::Float3 place = {static_cast<float>(placement.x()),
                              static_cast<float>(placement.y()),
                              static_cast<float>(placement.z())};
  stand->places.translations.push_back(place);
  stand->places.rotations.push_back(yaw);
  stand->places.scales.push_back({scale, scale, scale});
  const float cosine = 1 - 2 * yaw.z * yaw.z;
  const float sine = 2 * yaw.z * yaw.w;
  for (std::size_t k = 0; k < leaves.count(); ++k) {
    const core::Float3& p = leaves.translations[k];
    const core::Float3 turned = {cosine * p.x - sine * p.y,
                                 sine * p.x + cosine * p.y, p.z};
    leaves_.translations.push_back(place + scale * turned);
    leaves_.rotations.push_back(Turned(yaw, leaves.rotations[k]));
    leaves_.scales.push_back(scale * leaves.scales[k]);
  }
}

core::Scene ForestModel::SceneOf(const TreeLook& look) const {
  core::Scene scene = {look.materials(), {}};
  for (const std::unique_ptr<Stand>& stand : stands_) {
    scene.objects.push_back(
        {stand->name, &stand->wood, TreeLook::kBark, &stand->places});
  }
  if (leaves_.count() > 0) {
    scene.objects.push_back(
        {"leaves", &look.leaf(), TreeLook::kLeaf, &leaves_});
  }
  return scene;
}

}  // namespace terrane::client
