// Grid meshes, and the files that hold scenes.
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/codec/gltf.h"
#include "core/codec/obj.h"
#include "core/mesh/grid_mesh.h"
#include "core/mesh/scene.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
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

Scene SceneOf(const Mesh* mesh) {
  return {{{.name = "ground"}}, {{"surface", mesh, 0}}};
}

nlohmann::json JsonOf(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, 4);
  return nlohmann::json::parse(glb.substr(20, size));
}

nlohmann::json Encoded(const Scene& scene, const GlbOptions& options = {}) {
  const absl::StatusOr<std::string> glb = EncodeGlb(scene, options);
  EXPECT_TRUE(glb.ok()) << glb.status();
  return JsonOf(*glb);
}

// The bytes of an accessor's column.
std::string ColumnOf(const std::string& glb, std::size_t accessor) {
  const nlohmann::json json = JsonOf(glb);
  const nlohmann::json& view =
      json["bufferViews"]
          [json["accessors"][accessor]["bufferView"].get<std::size_t>()];
  const std::size_t binary =
      glb.size() - json["buffers"][0]["byteLength"].get<std::size_t>();
  return glb.substr(binary + view["byteOffset"].get<std::size_t>(),
                    view["byteLength"].get<std::size_t>());
}

template <typename Value>
std::string BytesOf(const std::vector<Value>& column) {
  return std::string(reinterpret_cast<const char*>(column.data()),
                     column.size() * sizeof(Value));
}

TEST(GltfTest, HoldsTheColumnsAsTheyAre) {
  Mesh mesh = FlatMesh(3, 2);
  mesh.colors.assign(6, {0.5f, 1, 0});
  const auto glb = EncodeGlb(SceneOf(&mesh));
  ASSERT_TRUE(glb.ok()) << glb.status();
  EXPECT_EQ(glb->substr(0, 4), "glTF");
  const nlohmann::json json = JsonOf(*glb);
  const nlohmann::json& positions = json["accessors"][0];
  EXPECT_EQ(positions["count"], 6);
  EXPECT_EQ(positions["min"], nlohmann::json({0.0, 0.0, 0.0}));
  EXPECT_EQ(positions["max"], nlohmann::json({2.0, 1.0, 0.0}));
  const nlohmann::json& primitive = json["meshes"][0]["primitives"][0];
  const auto column = [&](const char* name) {
    return ColumnOf(*glb, primitive["attributes"][name].get<std::size_t>());
  };
  EXPECT_EQ(column("POSITION"), BytesOf(mesh.positions));
  EXPECT_EQ(column("NORMAL"), BytesOf(mesh.normals));
  EXPECT_EQ(column("TEXCOORD_0"), BytesOf(mesh.uvs));
  EXPECT_EQ(column("COLOR_0"), BytesOf(mesh.colors));
  EXPECT_EQ(ColumnOf(*glb, primitive["indices"].get<std::size_t>()),
            BytesOf(std::vector<std::uint16_t>(mesh.indices.begin(),
                                               mesh.indices.end())));
  EXPECT_EQ(*EncodeGlb(SceneOf(&mesh)), *glb);
}

TEST(GltfTest, IndicesGrowWithTheMesh) {
  constexpr int kShort = 5123;
  constexpr int kInt = 5125;
  Mesh mesh;
  mesh.positions.resize(65'534);
  // The number of indices is odd: what follows starts at a whole word.
  mesh.indices = {0, 1, 65'533};
  const auto indices = [&] { return Encoded(SceneOf(&mesh))["accessors"][1]; };
  EXPECT_EQ(indices()["componentType"], kShort);
  EXPECT_EQ(Encoded(SceneOf(&mesh))["buffers"][0]["byteLength"],
            65'534 * 12 + 8);
  mesh.positions.resize(65'535);
  EXPECT_EQ(indices()["componentType"], kInt);
  mesh.indices = {0, 1, 65'534};
  const auto glb = EncodeGlb(SceneOf(&mesh));
  EXPECT_EQ(ColumnOf(*glb, 1), BytesOf(mesh.indices));
}

TEST(GltfTest, TakesSeveralObjectsAndMaterials) {
  const Mesh one = FlatMesh(2, 2);
  const Mesh two = FlatMesh(5, 5);
  const Scene scene = {
      {{.name = "bark"}, {.name = "leaf", .double_sided = true}},
      {{"trunk", &one, 0}, {"crown", &two, 1}, {"crown again", &two, 1}}};
  const nlohmann::json json = Encoded(scene);
  EXPECT_EQ(json["nodes"].size(), 4u);
  EXPECT_EQ(json["nodes"][0]["children"], nlohmann::json({1, 2, 3}));
  // A mesh that two objects show is there once.
  EXPECT_EQ(json["meshes"].size(), 2u);
  EXPECT_EQ(json["nodes"][3]["mesh"], 1);
  EXPECT_EQ(json["meshes"][1]["primitives"][0]["material"], 1);
  EXPECT_EQ(json["materials"][1]["doubleSided"], true);
}

TEST(GltfTest, MaterialsKeepThePapersNumbers) {
  const Mesh mesh = FlatMesh(2, 2);
  Scene scene = SceneOf(&mesh);
  const auto material = [&] { return Encoded(scene)["materials"][0]; };
  const auto roughness = [&] {
    return material()["pbrMetallicRoughness"]["roughnessFactor"].get<float>();
  };
  const auto ior = [&] {
    return material()["extensions"]["KHR_materials_ior"]["ior"].get<float>();
  };
  scene.materials[0] = {.name = "petal",
                        .base_color = {1, 0.5f, 0.25f},
                        .roughness = 0.75f,
                        .specular = 0.25f};
  EXPECT_EQ(
      material()["extras"],
      nlohmann::json::parse(
          R"({"Bc": [1, 0.5, 0.25], "Rn": 0.75, "g": 0.25, "r0": 0.25})"));
  EXPECT_EQ(ior(), 3);
  EXPECT_THAT(
      roughness(),
      FloatNear(std::pow(2 / (std::pow(8192.0f, 0.25f) + 2), 0.25f), 1e-6f));
  scene.materials[0].gloss = 0;
  scene.materials[0].specular = 0.04f;
  EXPECT_THAT(roughness(), FloatNear(std::pow(2.0f / 3, 0.25f), 1e-6f));
  EXPECT_EQ(ior(), 1.5f);
}

Instances ThreeInstances() {
  const float half_root = std::sqrt(0.5f);
  return {{{0, 0, 0}, {5, 0, 0}, {0, 0, 7}},
          {{}, {0, 0, half_root, half_root}, {1, 0, 0, 0}},
          {{1, 1, 1}, {2, 2, 2}, {1, 2, 3}}};
}

TEST(GltfTest, InstancesAsAnExtensionOrAsNodes) {
  const Mesh leaf = FlatMesh(2, 2);
  const Instances places = ThreeInstances();
  const Scene scene = {{{.name = "leaf"}}, {{"leaves", &leaf, 0, &places}}};
  const auto glb = EncodeGlb(scene);
  ASSERT_TRUE(glb.ok()) << glb.status();
  const nlohmann::json json = JsonOf(*glb);
  EXPECT_THAT(json["extensionsRequired"],
              ElementsAre("EXT_mesh_gpu_instancing"));
  EXPECT_EQ(json["nodes"].size(), 2u);
  const nlohmann::json& attributes =
      json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  const auto column = [&](const char* name) {
    return ColumnOf(*glb, attributes[name].get<std::size_t>());
  };
  EXPECT_EQ(column("TRANSLATION"), BytesOf(places.translations));
  EXPECT_EQ(column("ROTATION"), BytesOf(places.rotations));
  EXPECT_EQ(column("SCALE"), BytesOf(places.scales));

  const nlohmann::json nodes =
      Encoded(scene, {.instancing = GltfInstancing::kNodes});
  EXPECT_FALSE(nodes.contains("extensionsRequired"));
  EXPECT_EQ(nodes["nodes"].size(), 5u);
  EXPECT_EQ(nodes["nodes"][1]["children"], nlohmann::json({2, 3, 4}));
  EXPECT_EQ(nodes["nodes"][4]["translation"], nlohmann::json({0.0, 0.0, 7.0}));
  EXPECT_EQ(nodes["nodes"][4]["rotation"],
            nlohmann::json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(nodes["nodes"][4]["scale"], nlohmann::json({1.0, 2.0, 3.0}));
}

TEST(GltfTest, ScaleAndExtrasAndLevels) {
  const Mesh fine = FlatMesh(5, 5);
  const Mesh coarse = FlatMesh(2, 2);
  const std::vector<Scene> levels = {SceneOf(&fine), SceneOf(&coarse)};
  const auto glb = EncodeGlb(
      levels, {.metres_per_unit = 0.01, .extras = R"({"seed": "7"})"});
  ASSERT_TRUE(glb.ok()) << glb.status();
  const nlohmann::json json = JsonOf(*glb);
  EXPECT_EQ(json["asset"]["extras"]["seed"], "7");
  EXPECT_EQ(json["scenes"][0]["nodes"], nlohmann::json({0}));
  EXPECT_EQ(json["nodes"][0]["extensions"]["MSFT_lod"]["ids"],
            nlohmann::json({2}));
  for (const std::size_t root : {0u, 2u}) {
    EXPECT_EQ(json["nodes"][root]["scale"], nlohmann::json({0.01, 0.01, 0.01}));
  }
  EXPECT_EQ(json["nodes"][3]["mesh"], 1);
  EXPECT_EQ(json["materials"].size(), 1u);
}

std::string ErrorOf(const Scene& scene, const GlbOptions& options = {}) {
  return std::string(EncodeGlb(scene, options).status().message());
}

TEST(GltfTest, NamesWhatIsWrongWithAMesh) {
  Mesh mesh = FlatMesh(2, 2);
  EXPECT_THAT(ErrorOf({}), HasSubstr("objects: must not be empty"));
  mesh.indices[0] = 4;
  EXPECT_THAT(ErrorOf(SceneOf(&mesh)),
              HasSubstr("must be below the number of vertices, 4, got 4"));
  mesh.indices.clear();
  EXPECT_THAT(ErrorOf(SceneOf(&mesh)),
              HasSubstr("one triangle at least, got 0"));
  mesh = FlatMesh(2, 2);
  mesh.normals.pop_back();
  EXPECT_THAT(ErrorOf(SceneOf(&mesh)),
              HasSubstr("normals: must be one a vertex, got 3 of 4"));
  mesh = FlatMesh(2, 2);
  mesh.positions[2].y = kNan;
  EXPECT_THAT(ErrorOf(SceneOf(&mesh)),
              HasSubstr("objects[0].mesh.positions[2]: must be finite"));
  mesh = FlatMesh(2, 2);
  mesh.normals[1] = {0, 0, 2};
  EXPECT_THAT(ErrorOf(SceneOf(&mesh)),
              HasSubstr("normals[1]: must be a unit vector, got (0, 0, 2)"));
  mesh = FlatMesh(2, 2);
  mesh.colors.assign(4, {0, 0, 1.5f});
  EXPECT_THAT(ErrorOf(SceneOf(&mesh)),
              HasSubstr("colors[0]: must be in [0, 1], got (0, 0, 1.5)"));
}

TEST(GltfTest, NamesWhatIsWrongWithAScene) {
  const Mesh mesh = FlatMesh(2, 2);
  Scene scene = SceneOf(&mesh);
  scene.objects[0].material = 1;
  EXPECT_THAT(ErrorOf(scene), HasSubstr("objects[0].material: must be below"));
  scene = SceneOf(&mesh);
  scene.materials[0].specular = 1;
  EXPECT_THAT(ErrorOf(scene),
              HasSubstr("materials[0].specular: must be in [0, 1), got 1"));
  scene = SceneOf(&mesh);
  Instances places = ThreeInstances();
  scene.objects[0].instances = &places;
  places.rotations[2].x = 2;
  EXPECT_THAT(ErrorOf(scene),
              HasSubstr("instances.rotations[2]: must be a unit quaternion"));
  places = ThreeInstances();
  places.scales[1].y = 0;
  EXPECT_THAT(ErrorOf(scene),
              HasSubstr("instances.scales[1]: must be finite and above 0"));
  places.scales.pop_back();
  EXPECT_THAT(ErrorOf(scene), HasSubstr("must be columns of one length above "
                                        "0, got 3, 3 and 2"));
  EXPECT_THAT(ErrorOf(SceneOf(&mesh), {.extras = "{"}),
              HasSubstr("extras: must be JSON"));
  EXPECT_THAT(ErrorOf(SceneOf(&mesh), {.metres_per_unit = 0}),
              HasSubstr("metres_per_unit: must be finite and above 0"));
}

TEST(ObjTest, IsTextThatReadsBack) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0.1f}, {1, 0, 0}, {0, 1.5f, 0}};
  mesh.indices = {0, 1, 2};
  const auto obj = [&] { return *EncodeObj(SceneOf(&mesh), ""); };
  EXPECT_EQ(obj(), "o surface\nv 0 0 0.1\nv 1 0 0\nv 0 1.5 0\nf 1 2 3\n");
  mesh.normals.assign(3, {0, 0, 1});
  EXPECT_THAT(obj(), HasSubstr("\nf 1//1 2//2 3//3\n"));
  mesh.uvs.assign(3, {0, 0.5f});
  EXPECT_THAT(obj(), HasSubstr("vt 0 0.5\n"));
  EXPECT_THAT(obj(), HasSubstr("\nf 1/1/1 2/2/2 3/3/3\n"));
  mesh.colors.assign(3, {0, 0.5f, 1});
  EXPECT_THAT(obj(), HasSubstr("\nv 0 1.5 0 0 0.5 1\n"));
}

TEST(ObjTest, WritesInstancesOut) {
  Mesh leaf;
  leaf.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  leaf.normals.assign(3, {0, 0, 1});
  leaf.indices = {0, 1, 2};
  // A half turn about x, exact in floats.
  const Instances places = {
      {{0, 0, 0}, {5, 0, 0}}, {{}, {1, 0, 0, 0}}, {{1, 1, 1}, {1, 2, 4}}};
  const Scene scene = {{{.name = "bark"}, {}},
                       {{"trunk", &leaf, 0}, {"leaves", &leaf, 1, &places}}};
  const std::string obj = *EncodeObj(scene, "t.mtl");
  EXPECT_THAT(obj, HasSubstr("mtllib t.mtl\no trunk\nusemtl bark\n"));
  EXPECT_THAT(obj, HasSubstr("o leaves\nusemtl material-1\n"));
  EXPECT_THAT(obj, HasSubstr("v 5 0 0\nv 6 0 0\nv 5 -2 0\nvn 0 0 -1\n"));
  EXPECT_THAT(obj, HasSubstr("\nf 7//7 8//8 9//9\n"));
}

TEST(ObjTest, MaterialsHaveAFileOfTheirOwn) {
  const Mesh mesh = FlatMesh(2, 2);
  Scene scene = SceneOf(&mesh);
  scene.materials[0].gloss = 0;
  EXPECT_THAT(EncodeMtl(scene),
              HasSubstr("newmtl ground\nKd 0.8 0.8 0.8\nKs 0.04 0.04 "
                        "0.04\nNs 1\nNi 1.5"));
}

}  // namespace
}  // namespace terrane::core
