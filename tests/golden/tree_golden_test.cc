// The bytes of every kind of tree, kept as text: a change of any bit of any
// row, leaf or mesh shows up here, in every build and on every SIMD target.
//
//   golden_tree_test           compares with tree.txt
//   golden_tree_test --bless   writes tree.txt anew
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "core/tree/leaves.h"
#include "core/tree/tree_mesh.h"
#include "tests/core/whole_tree.h"
#include "tests/golden/golden_file.h"
#include "tests/golden/tree_cases.h"

namespace terrane::core {
namespace {

constexpr char kHeader[] =
    "# Golden trees: one line a case of tests/golden/tree_cases.cc.\n"
    "#   name | revision | parameters | rows, hash | leaves, hash | vertices, "
    "hash\n"
    "# The hashes are FNV-1a, 64 bits, of the columns as little-endian bytes.\n"
    "# New bytes need a new kTreeRevision (core/tree/tree_spec.h); then write\n"
    "# this file anew with: golden_tree_test --bless\n";

class Hash {
 public:
  template <typename Element>
  void Add(const std::vector<Element>& column) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(column.data());
    for (std::size_t i = 0; i < column.size() * sizeof(Element); ++i) {
      hash_ = (hash_ ^ bytes[i]) * 0x100000001B3u;
    }
  }
  std::string Text(std::size_t count) const {
    char text[64];
    std::snprintf(text, sizeof(text), " | %zu %016llx", count,
                  static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

std::string RowsText(const SegmentBlock& tree) {
  Hash hash;
  hash.Add(tree.parent);
  hash.Add(tree.start);
  hash.Add(tree.end);
  hash.Add(tree.radius_start);
  hash.Add(tree.radius_end);
  hash.Add(tree.flags);
  hash.Add(tree.attach);
  hash.Add(tree.chromosome);
  hash.Add(tree.extension);
  return hash.Text(tree.rows());
}

std::string LeavesText(const TreeSpec& spec, const SegmentBlock& tree) {
  LeafBlock leaves;
  if (spec.leaves.has_value()) {
    EXPECT_TRUE(PlaceLeaves(spec, tree, {}, &leaves).ok());
  }
  Hash hash;
  hash.Add(leaves.row);
  hash.Add(leaves.position);
  hash.Add(leaves.direction);
  hash.Add(leaves.normal);
  hash.Add(leaves.size);
  return hash.Text(leaves.count());
}

std::string MeshText(const SegmentBlock& tree) {
  const auto mesher = TreeMesher::Create({});
  Mesh mesh;
  std::size_t next = 0;
  EXPECT_TRUE(mesher->Next(tree, {}, 100'000'000, &next, &mesh).ok());
  Hash hash;
  hash.Add(mesh.positions);
  hash.Add(mesh.normals);
  hash.Add(mesh.uvs);
  hash.Add(mesh.indices);
  return hash.Text(mesh.positions.size());
}

std::string Line(const GoldenTree& golden) {
  const SegmentBlock tree = Grow(golden.spec);
  return golden.name + " | " + std::to_string(kTreeRevision) + " | " +
         golden.Parameters() + RowsText(tree) + LeavesText(golden.spec, tree) +
         MeshText(tree);
}

GoldenLines Lines() {
  GoldenLines lines;
  for (const GoldenTree& golden : GoldenTrees()) {
    lines.emplace_back(golden.name, Line(golden));
  }
  return lines;
}

void ExpectLines() { ExpectGoldenLines(Lines()); }

TEST(GoldenTrees, HaveTheBytesTheyHad) { ExpectLines(); }

TEST(GoldenTrees, HaveTheSameBytesOnEverySimdTarget) {
  OnEverySimdTarget(&ExpectLines);
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  return terrane::core::GoldenMain(argc, argv, terrane::core::kHeader,
                                   &terrane::core::Lines);
}
