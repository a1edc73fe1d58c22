// Writes scenes of every kind that the codec knows, for other programs to read:
// terrane_write_scenes FOLDER. What they hold is counted in check_assimp.sh.
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "core/codec/gltf.h"
#include "core/codec/obj.h"
#include "core/mesh/grid_mesh.h"

namespace terrane::core {
namespace {

// A grid of `side` * `side` vertices, one unit wide.
Mesh Grid(int side, bool columns) {
  std::vector<Float3> positions;
  std::vector<Float3> normals;
  std::vector<Float2> uvs;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(side - 1);
      const float y = static_cast<float>(j) / static_cast<float>(side - 1);
      positions.push_back({x, y, 0});
      normals.push_back({0, 0, 1});
      uvs.push_back({x, y});
    }
  }
  if (!columns) return MakeGridMesh({side, side, positions, {}, {}});
  Mesh mesh = MakeGridMesh({side, side, positions, normals, uvs});
  for (const Float2& uv : uvs) mesh.colors.push_back({uv.x, uv.y, 0.5f});
  return mesh;
}

// 25 leaves on a circle.
Instances Circle() {
  Instances places;
  for (int k = 0; k < 25; ++k) {
    const float turn = 0.25f * static_cast<float>(k);
    places.translations.push_back({3 * std::cos(turn), 3 * std::sin(turn), 1});
    places.rotations.push_back({0, 0, std::sin(turn / 2), std::cos(turn / 2)});
    places.scales.push_back({1, 1 + turn, 1});
  }
  return places;
}

bool Write(const std::string& path, const absl::StatusOr<std::string>& bytes) {
  if (!bytes.ok()) {
    std::cerr << path << ": " << bytes.status() << '\n';
    return false;
  }
  std::ofstream file(path, std::ios::binary);
  file << *bytes;
  return file.good();
}

bool WriteAll(const std::string& folder) {
  const Mesh bare = Grid(2, false);
  const Mesh small = Grid(9, true);
  const Mesh large = Grid(260, true);  // 67,600 vertices: 32-bit indices
  const Instances circle = Circle();
  const Scene plain = {{{.name = "one"}}, {{"bare", &bare, 0}}};
  const Scene plant = {
      {{.name = "bark", .base_color = {0.4f, 0.3f, 0.2f}},
       {.name = "leaf", .roughness = 0.5f, .double_sided = true}},
      {{"wood", &large, 0}, {"leaves", &small, 1, &circle}}};
  const Scene coarse = {plant.materials, {{"wood", &small, 0}}};
  const std::vector<Scene> levels = {plant, coarse, plain};
  const GlbOptions nodes = {.instancing = GltfInstancing::kNodes,
                            .metres_per_unit = 0.01,
                            .extras = R"({"seed": "7"})"};
  return Write(folder + "/plain.glb", EncodeGlb(plain)) &&
         Write(folder + "/extension.glb", EncodeGlb(plant)) &&
         Write(folder + "/nodes.glb", EncodeGlb(plant, nodes)) &&
         Write(folder + "/levels.glb", EncodeGlb(levels, nodes)) &&
         Write(folder + "/plant.obj", EncodeObj(plant, "plant.mtl")) &&
         Write(folder + "/plant.mtl", EncodeMtl(plant));
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  return argc == 2 && terrane::core::WriteAll(argv[1]) ? 0 : 1;
}
