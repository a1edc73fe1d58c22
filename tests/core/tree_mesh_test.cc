// Tubes and leaves: normals, winding, closed surfaces, texture seams, levels of
// detail, blocks; and leaves where the tips are.
#include "core/tree/tree_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/mesh/float3.h"
#include "core/mesh/leaf_mesh.h"
#include "core/tree/leaves.h"
#include "gtest/gtest.h"
#include "tests/core/whole_tree.h"

namespace terrane::core {
namespace {

TreeSpec Spec(int depth, int pieces = 1) {
  TreeSpec spec;
  spec.length_mode = LengthMode::kRelative;
  spec.dimensions = 3;
  spec.depth = depth;
  spec.bending = {pieces, pieces > 1 ? 1.0 : 0.0, 0};
  return spec;
}

// All blocks of a tree's mesh.
std::vector<Mesh> Blocks(const SegmentBlock& tree, const TubeSpec& tubes,
                         std::size_t most = TreeMesher::kBlockVertices) {
  const auto mesher = TreeMesher::Create(tubes);
  EXPECT_TRUE(mesher.ok()) << mesher.status();
  std::vector<Mesh> blocks;
  for (std::size_t next = 0; next < tree.rows();) {
    Mesh mesh;
    EXPECT_TRUE(mesher->Next(tree, {}, most, &next, &mesh).ok());
    blocks.push_back(std::move(mesh));
  }
  return blocks;
}

Mesh Whole(const SegmentBlock& tree, const TubeSpec& tubes) {
  std::vector<Mesh> blocks = Blocks(tree, tubes, 1u << 30);
  EXPECT_EQ(blocks.size(), 1u);
  return std::move(blocks.front());
}

using Corner = std::array<float, 3>;
Corner CornerOf(const Mesh& mesh, std::uint32_t vertex) {
  const Float3& p = mesh.positions[vertex];
  return {p.x, p.y, p.z};
}

// Edges by place, with how often each is run along one way more than the other:
// none of a closed surface is left.
std::map<std::pair<Corner, Corner>, int> OpenEdges(const Mesh& mesh) {
  std::map<std::pair<Corner, Corner>, int> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const Corner a = CornerOf(mesh, mesh.indices[i]);
    const Corner b = CornerOf(mesh, mesh.indices[next]);
    if (a == b) continue;
    edges[{a, b}] += 1;
    edges[{b, a}] -= 1;
  }
  std::erase_if(edges, [](const auto& edge) { return edge.second == 0; });
  return edges;
}

TEST(TreeMesh, HasUnitNormalsThatFaceOutLikeItsTriangles) {
  const Mesh mesh = Whole(Grow(Spec(5, 3)), {.ends = TubeEnds::kClosed});
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (const Float3& normal : mesh.normals) {
    ASSERT_NEAR(static_cast<double>(Length(normal)), 1, 1e-5);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return mesh.indices[i + k]; };
    ASSERT_LT(std::max({at(0), at(1), at(2)}), mesh.positions.size());
    const Float3 a = mesh.positions[at(0)];
    const Float3 face =
        Cross(mesh.positions[at(1)] - a, mesh.positions[at(2)] - a);
    const Float3 mean =
        mesh.normals[at(0)] + mesh.normals[at(1)] + mesh.normals[at(2)];
    // Squared: a triangle at an apex may be thin.
    ASSERT_GE(Dot(face, mean), -1e-5f * Dot(face, face)) << "triangle " << i;
  }
}

TEST(TreeMesh, TubesAreOpenOnlyWhereIntended) {
  const SegmentBlock tree = Grow(Spec(4, 2));
  const std::size_t branches = tree.rows() / 2;
  EXPECT_TRUE(OpenEdges(Whole(tree, {.ends = TubeEnds::kClosed})).empty());
  const TubeSpec joined = {.sides = 6, .least_sides = 6};
  // Every branch but the trunk has its base open: a ring, both ways round.
  EXPECT_EQ(OpenEdges(Whole(tree, joined)).size(), (branches - 1) * 6 * 2);
  const TubeSpec open = {.sides = 6, .least_sides = 6, .ends = TubeEnds::kOpen};
  EXPECT_EQ(OpenEdges(Whole(tree, open)).size(), branches * 6 * 2 * 2);
}

TEST(TreeMesh, VerticesLieOnTheTube) {
  const SegmentBlock tree = Grow(Spec(0));
  const Mesh mesh = Whole(tree, {.ends = TubeEnds::kOpen});
  for (const Float3& p : mesh.positions) {
    const float radius = p.z == 0 ? tree.radius_start[0] : tree.radius_end[0];
    EXPECT_NEAR(static_cast<double>(std::hypot(p.x, p.y)),
                static_cast<double>(radius), 1e-3);
  }
  EXPECT_EQ(mesh.positions.size(), 2u * 13);
  EXPECT_EQ(mesh.indices.size(), 12u * 2 * 3);
}

TEST(TreeMesh, TextureMeetsItselfAroundTheTube) {
  const TubeSpec tubes = {.sides = 9,
                          .ends = TubeEnds::kOpen,
                          .texture_length = 50,
                          .texture_repeats = 3};
  const Mesh mesh = Whole(Grow(Spec(0)), tubes);
  for (std::size_t ring = 0; ring < 2; ++ring) {
    const std::size_t first = ring * 10;
    const std::size_t last = first + 9;
    EXPECT_EQ(mesh.positions[first], mesh.positions[last]);
    EXPECT_EQ(mesh.normals[first], mesh.normals[last]);
    EXPECT_EQ(mesh.uvs[first].x, 0);
    EXPECT_EQ(mesh.uvs[last].x, 3);
    EXPECT_EQ(mesh.uvs[first].y, ring == 0 ? 0.0f : 310.0f / 50);
  }
}

TEST(TreeMesh, PiecesShareTheirRings) {
  const Mesh bent =
      Whole(Grow(Spec(0, 5)), {.sides = 8, .ends = TubeEnds::kOpen});
  EXPECT_EQ(bent.positions.size(), 6u * 9);
}

TEST(TreeMesh, LevelsOfDetailHaveFewerFaces) {
  const SegmentBlock tree = Grow(Spec(7));
  const auto triangles = [&](const TubeSpec& tubes) {
    std::size_t count = 0;
    for (const Mesh& mesh : Blocks(tree, tubes)) count += mesh.indices.size();
    return count / 3;
  };
  const std::size_t fine = triangles({.sides = 24});
  const std::size_t round = triangles({.sides = 12});
  const std::size_t coarse = triangles({.sides = 12, .last_generation = 4});
  EXPECT_GT(fine, round);
  EXPECT_GT(round, 4 * coarse);
  const auto mesher = TreeMesher::Create({.sides = 12});
  EXPECT_EQ(mesher->SidesOf(0), 12);
  EXPECT_EQ(mesher->SidesOf(1), 8);
  EXPECT_EQ(mesher->SidesOf(9), 3);
}

TEST(TreeMesh, BlocksHoldWhatOneMeshWouldAndStayBelowTheirSize) {
  const SegmentBlock tree = Grow(Spec(7, 2));
  const Mesh whole = Whole(tree, {});
  const std::vector<Mesh> blocks = Blocks(tree, {}, 5000);
  EXPECT_GT(blocks.size(), 3u);
  std::vector<Float3> positions;
  std::vector<std::uint32_t> indices;
  for (const Mesh& mesh : blocks) {
    EXPECT_LE(mesh.positions.size(), 5000u);
    for (const std::uint32_t index : mesh.indices) {
      indices.push_back(index + static_cast<std::uint32_t>(positions.size()));
    }
    positions.insert(positions.end(), mesh.positions.begin(),
                     mesh.positions.end());
  }
  EXPECT_EQ(positions, whole.positions);
  EXPECT_EQ(indices, whole.indices);
}

TEST(TreeMesh, StopsWhenAsked) {
  const SegmentBlock tree = Grow(Spec(5));
  std::stop_source source;
  source.request_stop();
  std::size_t next = 0;
  Mesh mesh;
  EXPECT_EQ(TreeMesher::Create({})
                ->Next(tree, source.get_token(), 1000, &next, &mesh)
                .code(),
            absl::StatusCode::kCancelled);
}

TEST(TreeMesh, ACantorSetHasNoTubes) {
  TreeSpec spec;
  spec.form = TreeForm::kCantor;
  EXPECT_TRUE(Whole(Grow(spec), {}).positions.empty());
}

TEST(Leaves, SitOnTheTipsWithTheirSizes) {
  TreeSpec spec = Spec(6, 2);
  spec.genetic.twigs_end = true;
  spec.leaves = LeafSpec{.count = 4, .size_share = 0.5, .size_variation = 0.2};
  const SegmentBlock tree = Grow(spec);
  LeafBlock leaves;
  ASSERT_TRUE(PlaceLeaves(spec, tree, {}, &leaves).ok());
  const std::vector<int> generations = GenerationsOf(tree);
  std::size_t tips = 0;
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    tips += (tree.flags[row] & kContinuedFlag) == 0 &&
            (generations[row] == 6 || (tree.flags[row] & kTerminalFlag) != 0);
  }
  ASSERT_EQ(leaves.count(), 4 * tips);
  std::set<float> shares;
  for (std::size_t i = 0; i < leaves.count(); ++i) {
    const std::size_t row = leaves.row[i];
    const Float3 along = tree.end[row] - tree.start[row];
    EXPECT_NEAR(static_cast<double>(Length(leaves.direction[i])), 1, 1e-5);
    EXPECT_NEAR(static_cast<double>(Length(leaves.normal[i])), 1, 1e-5);
    EXPECT_NEAR(
        static_cast<double>(Dot(leaves.direction[i], Normalized(along))),
        0.6428, 1e-3);  // 50 degrees
    const float share = leaves.size[i] / (2 * Length(along));
    EXPECT_GE(share, 0.5f * 0.79f);
    EXPECT_LE(share, 0.5f * 1.21f);
    shares.insert(share);
  }
  EXPECT_GT(shares.size(), leaves.count() / 2);
}

TEST(Leaves, SitOnSeveralGenerationsAndOnEveryPiece) {
  TreeSpec spec;
  spec.length_mode = LengthMode::kRelative;
  spec.dimensions = 3;
  spec.depth = 5;
  spec.bending.pieces = 3;
  spec.leaves = LeafSpec{.count = 2,
                         .size_variation = 0,
                         .size = 7,
                         .generations = 2,
                         .every_piece = true};
  const SegmentBlock tree = Grow(spec);
  const auto first = static_cast<std::size_t>(tree.marks[3].end_row);
  LeafBlock leaves;
  ASSERT_TRUE(PlaceLeaves(spec, tree, {}, &leaves).ok());
  EXPECT_EQ(leaves.count(), 2 * (tree.rows() - first));
  EXPECT_EQ(leaves.row.front(), first);
  for (const float size : leaves.size) EXPECT_EQ(size, 7);
  spec.leaves->every_piece = false;
  ASSERT_TRUE(PlaceLeaves(spec, tree, {}, &leaves).ok());
  EXPECT_EQ(leaves.count(), 2 * (tree.rows() - first) / 3);
}

TEST(LeafMesh, LiesAlongXWithItsFaceUp) {
  const Mesh leaf = MakeLeafMesh({.width = 0.4});
  ASSERT_EQ(leaf.indices.size(), 8u * 3);
  float widest = 0;
  for (std::size_t k = 0; k < leaf.positions.size(); ++k) {
    const Float3& p = leaf.positions[k];
    EXPECT_GE(p.x, 0);
    EXPECT_LE(p.x, 1);
    EXPECT_GE(p.z, 0);
    EXPECT_NEAR(static_cast<double>(Length(leaf.normals[k])), 1, 1e-6);
    EXPECT_GT(leaf.normals[k].z, 0.9f);
    widest = std::max(widest, 2 * p.y);
  }
  EXPECT_NEAR(static_cast<double>(widest), 0.4 * 0.9, 1e-6);
  for (std::size_t k = 0; k < leaf.indices.size(); k += 3) {
    const Float3 a = leaf.positions[leaf.indices[k]];
    const Float3 b = leaf.positions[leaf.indices[k + 1]];
    const Float3 c = leaf.positions[leaf.indices[k + 2]];
    EXPECT_GT(Cross(b - a, c - a).z, 0);
  }
  const Mesh spray = MakeLeafMesh({.blades = 5, .spread_deg = 180});
  EXPECT_EQ(spray.positions.size(), 5 * leaf.positions.size());
  EXPECT_NEAR(static_cast<double>(spray.positions[7].y), -1, 1e-6);
  EXPECT_NEAR(static_cast<double>(spray.positions[4 * 8 + 7].y), 1, 1e-6);
}

TEST(LeafMesh, IsTurnedToItsDirectionAndFace) {
  const Float3 directions[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                               {0, -1, 0}, {0, 0, 1},  {0.6f, 0, -0.8f}};
  for (const Float3& direction : directions) {
    for (const Float3& other : directions) {
      const Float3 across = Cross(direction, other);
      if (Length(across) < 0.1f) continue;
      const Float3 normal = Normalized(across);
      const Quaternion q = LeafRotation(direction, normal);
      const Float3 axis = {q.x, q.y, q.z};
      const auto turned = [&](const Float3& v) {
        const Float3 once = 2.0f * Cross(axis, v);
        return v + q.w * once + Cross(axis, once);
      };
      EXPECT_LT(Length(turned({1, 0, 0}) - direction), 1e-6f);
      EXPECT_LT(Length(turned({0, 0, 1}) - normal), 1e-6f);
    }
  }
}

TEST(Leaves, StopWhenAsked) {
  TreeSpec spec = Spec(4);
  spec.leaves.emplace();
  std::stop_source source;
  source.request_stop();
  LeafBlock leaves;
  EXPECT_EQ(PlaceLeaves(spec, Grow(spec), source.get_token(), &leaves).code(),
            absl::StatusCode::kCancelled);
}

TEST(Leaves, AreTheSameWhateverTheBlocks) {
  TreeSpec spec = Spec(6);
  spec.leaves.emplace();
  LeafBlock whole;
  ASSERT_TRUE(PlaceLeaves(spec, Grow(spec), {}, &whole).ok());
  const auto tree = Tree::Create(spec);
  TreeGenerator generator(*tree, 0, {7, 50});
  std::vector<Float3> positions;
  std::vector<float> sizes;
  SegmentBlock block;
  LeafBlock leaves;
  while (!generator.Done()) {
    ASSERT_TRUE(generator.Next({}, &block).ok());
    ASSERT_TRUE(PlaceLeaves(spec, block, {}, &leaves).ok());
    positions.insert(positions.end(), leaves.position.begin(),
                     leaves.position.end());
    sizes.insert(sizes.end(), leaves.size.begin(), leaves.size.end());
  }
  EXPECT_EQ(positions, whole.position);
  EXPECT_EQ(sizes, whole.size);
}

}  // namespace
}  // namespace terrane::core
