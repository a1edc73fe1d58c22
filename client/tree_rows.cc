#include "client/tree_rows.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/column_bytes.h"
#include "core/mesh/float3.h"
#include "core/mesh/grid_mesh.h"
#include "core/mesh/leaf_mesh.h"

namespace terrane::client {
namespace {

template <typename Value>
std::vector<Value> ColumnOf(const std::string& bytes) {
  std::vector<Value> column;
  core::AppendColumn(bytes, &column);
  return column;
}

}  // namespace

void AppendRows(const v1::SegmentRows& rows, core::SegmentBlock* tree) {
  if (tree->rows() == 0) {
    tree->first_row = rows.first_row();
    tree->first_generation = rows.first_generation();
  }
  core::AppendColumn(rows.parents(), &tree->parent);
  core::AppendColumn(rows.starts(), &tree->start);
  core::AppendColumn(rows.ends(), &tree->end);
  core::AppendColumn(rows.radius_starts(), &tree->radius_start);
  core::AppendColumn(rows.radius_ends(), &tree->radius_end);
  core::AppendColumn(rows.flags(), &tree->flags);
  core::AppendColumn(rows.attaches(), &tree->attach);
  core::AppendColumn(rows.chromosomes(), &tree->chromosome);
  core::AppendColumn(rows.extensions(), &tree->extension);
  for (const v1::GenerationMark& mark : rows.marks()) {
    tree->marks.push_back({mark.generation(), mark.end_row()});
  }
}

absl::Status AppendTubes(const v1::TubeBlock& block, core::Mesh* mesh) {
  const auto before = static_cast<std::int64_t>(mesh->positions.size());
  if (before + block.vertices() > core::kMaxMeshVertices) {
    return absl::ResourceExhaustedError(
        "a mesh numbers at most " + std::to_string(core::kMaxMeshVertices) +
        " vertices; leave generations out with --lod or --depth");
  }
  core::AppendColumn(block.positions(), &mesh->positions);
  core::AppendColumn(block.normals(), &mesh->normals);
  core::AppendColumn(block.uvs(), &mesh->uvs);
  const std::size_t first = mesh->indices.size();
  core::AppendColumn(block.indices(), &mesh->indices);
  for (std::size_t k = first; k < mesh->indices.size(); ++k) {
    mesh->indices[k] += static_cast<std::uint32_t>(before);
  }
  return absl::OkStatus();
}

void AppendLeaves(const v1::LeafRows& leaves, core::Instances* instances) {
  core::AppendColumn(leaves.positions(), &instances->translations);
  const auto directions = ColumnOf<core::Float3>(leaves.directions());
  const auto normals = ColumnOf<core::Float3>(leaves.normals());
  const auto sizes = ColumnOf<float>(leaves.sizes());
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    instances->rotations.push_back(
        core::LeafRotation(directions[k], normals[k]));
    instances->scales.push_back({sizes[k], sizes[k], sizes[k]});
  }
}

absl::StatusOr<StreamedTree> StreamWholeTree(const v1::TreeRecipe& recipe,
                                             ProgressMode progress,
                                             TreeBackend* backend,
                                             std::stop_token stop) {
  StreamedTree tree;
  std::unique_ptr<Progress> shown;
  v1::StreamTreeRequest request;
  *request.mutable_tree()->mutable_recipe() = recipe;
  const absl::Status status = backend->StreamTree(
      request,
      [&](const v1::TreeHeader& header) {
        tree.header = header;
        shown = std::make_unique<Progress>(progress, header.segments_most(),
                                           "segments");
        return absl::OkStatus();
      },
      [&](const v1::SegmentRows& rows) {
        AppendRows(rows, &tree.rows);
        shown->Advance(rows.rows());
        return absl::OkStatus();
      },
      std::move(stop));
  if (!status.ok()) return status;
  return tree;
}

double ScaleOf(const v1::TreePlacement& placement) {
  return placement.scale() == 0 ? 1 : placement.scale();
}

void PlaceTree(const v1::TreePlacement& placement, core::SegmentBlock* tree) {
  const double scale = ScaleOf(placement);
  const double yaw = placement.yaw_deg() * std::numbers::pi / 180;
  const double cosine = scale * std::cos(yaw);
  const double sine = scale * std::sin(yaw);
  const auto move = [&](core::Float3* p) {
    const auto x = static_cast<double>(p->x);
    const auto y = static_cast<double>(p->y);
    const auto z = static_cast<double>(p->z);
    *p = {static_cast<float>(placement.x() + cosine * x - sine * y),
          static_cast<float>(placement.y() + sine * x + cosine * y),
          static_cast<float>(placement.z() + scale * z)};
  };
  for (core::Float3& start : tree->start) move(&start);
  for (core::Float3& end : tree->end) move(&end);
  for (float& radius : tree->radius_start) radius *= static_cast<float>(scale);
  for (float& radius : tree->radius_end) radius *= static_cast<float>(scale);
}

}  // namespace terrane::client
