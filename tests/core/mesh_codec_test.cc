// Grid meshes and the files that hold them.
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/codec/gltf.h"
#include "core/codec/obj.h"
#include "core/mesh/grid_mesh.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A flat grid of unit cells in the plane z = 0, with normals and uvs.
Mesh FlatMesh(std::int64_t columns, std::int64_t rows, int left_out = -1) {
  std::vector<Float3> positions;
  std::vector<Float2> uvs;
  for (std::int64_t j = 0; j < rows; ++j) {
    for (std::int64_t i = 0; i < columns; ++i) {
      positions.push_back({static_cast<float>(i), static_cast<float>(j), 0});
      uvs.push_back({static_cast<float>(i), static_cast<float>(j)});
    }
  }
  if (left_out >= 0) positions[static_cast<std::size_t>(left_out)].x = kNan;
  const std::vector<Float3> normals(positions.size(), Float3{0, 0, 1});
  return MakeGridMesh({columns, rows, positions, normals, uvs});
}

TEST(GridMeshTest, TrianglesTurnCounterClockwise) {
  const Mesh mesh = FlatMesh(3, 4);
  EXPECT_EQ(mesh.positions.size(), 12u);
  EXPECT_EQ(mesh.indices.size(), 3u * 2 * 2 * 3);
  double area = 0;
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
    const Float3& a = mesh.positions[mesh.indices[k]];
    const Float3& b = mesh.positions[mesh.indices[k + 1]];
    const Float3& c = mesh.positions[mesh.indices[k + 2]];
    const float twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    EXPECT_EQ(twice, 1);
    area += static_cast<double>(twice) / 2;
  }
  EXPECT_EQ(area, 6);
}

TEST(GridMeshTest, WhatIsLeftOutTakesItsTrianglesAlong) {
  // The corner vertex of a 2 x 2 grid: one triangle does without it.
  const Mesh corner = FlatMesh(2, 2, 0);
  EXPECT_EQ(corner.positions.size(), 3u);
  EXPECT_THAT(corner.indices, ElementsAre(0, 1, 2));
  EXPECT_EQ(corner.normals.size(), 3u);
  EXPECT_EQ(corner.uvs.size(), 3u);
  // The middle of a 3 x 3 grid: six of eight triangles go.
  EXPECT_EQ(FlatMesh(3, 3, 4).indices.size(), 2u * 3);
}

GltfScene SceneOf(const Mesh* mesh) {
  return {{{.name = "ground"}}, {{"surface", mesh, 0}}};
}

nlohmann::json JsonOf(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, 4);
  return nlohmann::json::parse(glb.substr(20, size));
}

TEST(GltfTest, HoldsTheColumnsAsTheyAre) {
  const Mesh mesh = FlatMesh(3, 2);
  const auto glb = EncodeGlb(SceneOf(&mesh));
  ASSERT_TRUE(glb.ok()) << glb.status();
  EXPECT_EQ(glb->substr(0, 4), "glTF");
  const nlohmann::json json = JsonOf(*glb);
  const nlohmann::json& positions = json["accessors"][0];
  EXPECT_EQ(positions["count"], 6);
  EXPECT_EQ(positions["min"], nlohmann::json({0.0, 0.0, 0.0}));
  EXPECT_EQ(positions["max"], nlohmann::json({2.0, 1.0, 0.0}));
  const std::size_t binary =
      glb->size() - json["buffers"][0]["byteLength"].get<std::size_t>();
  EXPECT_EQ(std::memcmp(glb->data() + binary, mesh.positions.data(),
                        mesh.positions.size() * sizeof(Float3)),
            0);
  EXPECT_EQ(json["accessors"][3]["count"], mesh.indices.size());
  EXPECT_EQ(*EncodeGlb(SceneOf(&mesh)), *glb);
}

TEST(GltfTest, TakesSeveralObjectsAndMaterials) {
  const Mesh one = FlatMesh(2, 2);
  const Mesh two = FlatMesh(5, 5);
  const GltfScene scene = {
      {{.name = "bark"}, {.name = "leaf", .double_sided = true}},
      {{"trunk", &one, 0}, {"crown", &two, 1}}};
  const auto glb = EncodeGlb(scene);
  ASSERT_TRUE(glb.ok());
  const nlohmann::json json = JsonOf(*glb);
  EXPECT_EQ(json["nodes"].size(), 3u);
  EXPECT_EQ(json["nodes"][0]["children"], nlohmann::json({1, 2}));
  EXPECT_EQ(json["meshes"][1]["primitives"][0]["material"], 1);
}

TEST(GltfTest, NamesWhatIsWrong) {
  Mesh mesh = FlatMesh(2, 2);
  const auto error = [](const GltfScene& scene) {
    return std::string(EncodeGlb(scene).status().message());
  };
  EXPECT_THAT(error({}), HasSubstr("objects: must not be empty"));
  GltfScene scene = SceneOf(&mesh);
  scene.objects[0].material = 1;
  EXPECT_THAT(error(scene), HasSubstr("objects[0].material: is not there"));
  mesh.indices[0] = 4;
  EXPECT_THAT(error(SceneOf(&mesh)),
              HasSubstr("must be below the number of vertices, 4, got 4"));
  mesh.indices.clear();
  EXPECT_THAT(error(SceneOf(&mesh)), HasSubstr("one triangle at least, got 0"));
  mesh = FlatMesh(2, 2);
  mesh.normals.pop_back();
  EXPECT_THAT(error(SceneOf(&mesh)),
              HasSubstr("normals: must be one a vertex"));
}

TEST(ObjTest, IsTextThatReadsBack) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0.1f}, {1, 0, 0}, {0, 1.5f, 0}};
  mesh.indices = {0, 1, 2};
  EXPECT_EQ(EncodeObj(mesh, "s"),
            "o s\nv 0 0 0.1\nv 1 0 0\nv 0 1.5 0\nf 1 2 3\n");
  mesh.normals.assign(3, {0, 0, 1});
  EXPECT_THAT(EncodeObj(mesh, "s"), HasSubstr("\nf 1//1 2//2 3//3\n"));
  mesh.uvs.assign(3, {0, 0.5f});
  EXPECT_THAT(EncodeObj(mesh, "s"), HasSubstr("vt 0 0.5\n"));
  EXPECT_THAT(EncodeObj(mesh, "s"), HasSubstr("\nf 1/1/1 2/2/2 3/3/3\n"));
}

}  // namespace
}  // namespace terrane::core
