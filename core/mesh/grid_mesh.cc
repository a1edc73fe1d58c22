#include "core/mesh/grid_mesh.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace terrane::core {
namespace {

constexpr std::uint32_t kUnused = 0xFFFFFFFF;

class GridTriangulation {
 public:
  explicit GridTriangulation(const GridVertices& grid)
      : grid_(grid), index_of_(grid.positions.size(), kUnused) {}

  Mesh Run() {
    const auto columns = static_cast<std::size_t>(grid_.columns);
    const auto rows = static_cast<std::size_t>(grid_.rows);
    for (std::size_t j = 0; j + 1 < rows; ++j) {
      for (std::size_t i = 0; i + 1 < columns; ++i) {
        const std::size_t corner = j * columns + i;
        AddTriangle({corner, corner + 1, corner + columns});
        AddTriangle({corner + 1, corner + columns + 1, corner + columns});
      }
    }
    return std::move(mesh_);
  }

 private:
  void AddTriangle(const std::array<std::size_t, 3>& vertices) {
    for (const std::size_t vertex : vertices) {
      if (std::isnan(grid_.positions[vertex].x)) return;
    }
    for (const std::size_t vertex : vertices) {
      mesh_.indices.push_back(IndexOf(vertex));
    }
  }

  std::uint32_t IndexOf(std::size_t vertex) {
    std::uint32_t& index = index_of_[vertex];
    if (index == kUnused) {
      index = static_cast<std::uint32_t>(mesh_.positions.size());
      mesh_.positions.push_back(grid_.positions[vertex]);
      if (!grid_.normals.empty()) {
        mesh_.normals.push_back(grid_.normals[vertex]);
      }
      if (!grid_.uvs.empty()) mesh_.uvs.push_back(grid_.uvs[vertex]);
    }
    return index;
  }

  const GridVertices& grid_;
  std::vector<std::uint32_t> index_of_;
  Mesh mesh_;
};

}  // namespace

Mesh MakeGridMesh(const GridVertices& grid) {
  return GridTriangulation(grid).Run();
}

}  // namespace terrane::core
