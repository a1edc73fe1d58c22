#include "client/tree_verifiers.h"

#include <algorithm>
#include <string>

#include "client/column_check.h"
#include "core/base/column_bytes.h"

namespace terrane::client {
namespace {

// A parent's row is before its child's; row 0 is the trunk.
absl::Status CheckParents(const std::string& block,
                          const v1::SegmentRows& rows) {
  for (std::int64_t k = 0; k < rows.rows(); ++k) {
    const std::int64_t row = rows.first_row() + k;
    if (row > 0 && core::ElementOf<std::uint32_t>(rows.parents(), k) >= row) {
      return WrongBlock(block, "row " + std::to_string(row) +
                                   " has a parent that is not before it");
    }
  }
  return absl::OkStatus();
}

absl::Status CheckRows(const v1::SegmentRows& rows, bool has_extensions,
                       std::int64_t* next_row) {
  const std::string block = "rows from " + std::to_string(rows.first_row());
  const std::int64_t count = rows.rows();
  absl::Status status = CheckPlace(block, rows.first_row(), *next_row);
  if (status.ok()) {
    status = CheckColumns(
        block,
        {{"parents", rows.parents(), 4 * count},
         {"starts", rows.starts(), 12 * count},
         {"ends", rows.ends(), 12 * count},
         {"radii", rows.radius_starts(), 4 * count},
         {"radii", rows.radius_ends(), 4 * count},
         {"flags", rows.flags(), 1 * count},
         {"attaches", rows.attaches(), 4 * count},
         {"chromosomes", rows.chromosomes(), 4 * count},
         {"extensions", rows.extensions(), has_extensions ? 4 * count : 0}},
        rows.checksum());
  }
  if (status.ok()) status = CheckParents(block, rows);
  if (status.ok()) *next_row += rows.rows();
  return status;
}

absl::Status CheckLeaves(const v1::LeafRows& leaves, std::int64_t* next_leaf) {
  const std::string block =
      "leaves from " + std::to_string(leaves.first_leaf());
  const std::int64_t count = leaves.leaves();
  absl::Status status = CheckPlace(block, leaves.first_leaf(), *next_leaf);
  if (status.ok()) {
    status = CheckColumns(block,
                          {{"rows", leaves.rows(), 4 * count},
                           {"positions", leaves.positions(), 12 * count},
                           {"directions", leaves.directions(), 12 * count},
                           {"normals", leaves.normals(), 12 * count},
                           {"sizes", leaves.sizes(), 4 * count}},
                          leaves.checksum());
  }
  if (status.ok()) *next_leaf += leaves.leaves();
  return status;
}

absl::Status CheckTriangles(const std::string& name,
                            const v1::TubeBlock& block) {
  const auto count = static_cast<std::int64_t>(block.indices().size() / 4);
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t vertex =
        core::ElementOf<std::uint32_t>(block.indices(), k);
    if (vertex >= block.vertices()) {
      return WrongBlock(name, "has a triangle with vertex " +
                                  std::to_string(vertex) + " of " +
                                  std::to_string(block.vertices()));
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status TreeStreamVerifier::CheckHeader(const v1::TreeHeader& header) {
  if (has_header_ && (header.recipe_hash() != header_.recipe_hash() ||
                      header.revision() != header_.revision())) {
    return absl::FailedPreconditionError(
        "the server's answer changed between the parts of a resumed stream: "
        "another recipe or algorithm revision");
  }
  header_ = header;
  has_header_ = true;
  return absl::OkStatus();
}

absl::Status TreeStreamVerifier::CheckEnd() const {
  if (!has_header_) return absl::DataLossError("the stream had no header");
  return absl::OkStatus();
}

absl::Status TreeRowsVerifier::CheckTile(const v1::SegmentRows& rows) {
  return CheckRows(rows, header().recipe().dimensions() == 3, &next_index_);
}

absl::Status TreeLeavesVerifier::CheckTile(const v1::LeafRows& leaves) {
  return CheckLeaves(leaves, &next_index_);
}

absl::Status TubesVerifier::CheckTile(const v1::TubeBlock& block) {
  const std::string name = "tubes " + std::to_string(block.index());
  absl::Status status = CheckPlace(name, block.index(), next_index_);
  if (status.ok() && block.indices().size() % 12 != 0) {
    status = WrongBlock(name, "has a part of a triangle");
  }
  if (status.ok()) {
    const std::int64_t count = block.vertices();
    const auto indices = static_cast<std::int64_t>(block.indices().size());
    status = CheckColumns(name,
                          {{"positions", block.positions(), 12 * count},
                           {"normals", block.normals(), 12 * count},
                           {"texture coordinates", block.uvs(), 8 * count},
                           {"indices", block.indices(), indices}},
                          block.checksum());
  }
  if (status.ok()) status = CheckTriangles(name, block);
  if (status.ok()) ++next_index_;
  return status;
}

ForestVerifier::ForestVerifier(const v1::StreamForestRequest& request)
    : TreeStreamVerifier(request.first_tree()),
      trees_(request.has_seeds() ? request.seeds().count()
                                 : request.placements().placements_size()) {}

absl::Status ForestVerifier::CheckHeader(const v1::TreeHeader& header) {
  blocks_before_ = std::max(blocks_, blocks_before_);
  blocks_ = 0;
  next_row_ = 0;
  next_leaf_ = 0;
  return TreeStreamVerifier::CheckHeader(header);
}

absl::Status ForestVerifier::CheckTile(const v1::ForestBlock& block) {
  const std::string name = "tree " + std::to_string(block.tree());
  absl::Status status = CheckPlace(name, block.tree(), next_index_);
  if (status.ok()) {
    status = block.has_leaves()
                 ? CheckLeaves(block.leaves(), &next_leaf_)
                 : CheckRows(block.segments(),
                             header().recipe().dimensions() == 3, &next_row_);
  }
  if (!status.ok()) return status;
  is_repeat_ = ++blocks_ <= blocks_before_;
  if (!block.ends_tree()) return absl::OkStatus();
  ++next_index_;
  next_row_ = 0;
  next_leaf_ = 0;
  blocks_ = 0;
  blocks_before_ = 0;
  return absl::OkStatus();
}

absl::Status ForestVerifier::CheckEnd() const {
  const absl::Status status = TreeStreamVerifier::CheckEnd();
  if (!status.ok() || next_index_ == trees_) return status;
  return absl::DataLossError("the stream ended after " +
                             std::to_string(next_index_) + " of " +
                             std::to_string(trees_) + " trees");
}

}  // namespace terrane::client
