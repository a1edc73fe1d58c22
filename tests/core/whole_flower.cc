#include "tests/core/whole_flower.h"

#include <utility>
#include <vector>

#include "gtest/gtest.h"

namespace terrane::core {
namespace {

template <typename Element>
void Append(const std::vector<Element>& from, std::vector<Element>* to) {
  to->insert(to->end(), from.begin(), from.end());
}

template <typename Element>
void AppendBytes(const std::vector<Element>& column, std::size_t from,
                 std::size_t to, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(column.data() + from),
                (to - from) * sizeof(Element));
}

}  // namespace

std::shared_ptr<const Flower> MakeFlower(const FlowerSpec& spec) {
  auto flower = Flower::Create(spec);
  EXPECT_TRUE(flower.ok()) << flower.status();
  return *std::move(flower);
}

InstanceBlock GrowRows(std::shared_ptr<const Flower> flower,
                       std::int64_t from_row, std::size_t block_rows) {
  FlowerGenerator generator(std::move(flower), from_row, block_rows);
  InstanceBlock all;
  all.first_row = from_row;
  InstanceBlock block;
  while (!generator.Done()) {
    const absl::Status status = generator.Next({}, &block);
    EXPECT_TRUE(status.ok()) << status;
    EXPECT_LE(block.rows(), block_rows);
    EXPECT_EQ(block.first_row,
              from_row + static_cast<std::int64_t>(all.rows()));
    Append(block.prototype, &all.prototype);
    Append(block.translation, &all.translation);
    Append(block.rotation, &all.rotation);
    Append(block.scale, &all.scale);
    Append(block.organ, &all.organ);
    Append(block.n, &all.n);
    Append(block.plant, &all.plant);
  }
  return all;
}

InstanceBlock GrowRows(const FlowerSpec& spec) {
  return GrowRows(MakeFlower(spec));
}

std::string RowBytes(const InstanceBlock& block, std::size_t from,
                     std::size_t to) {
  std::string bytes;
  AppendBytes(block.prototype, from, to, &bytes);
  AppendBytes(block.translation, from, to, &bytes);
  AppendBytes(block.rotation, from, to, &bytes);
  AppendBytes(block.scale, from, to, &bytes);
  AppendBytes(block.organ, from, to, &bytes);
  AppendBytes(block.n, from, to, &bytes);
  AppendBytes(block.plant, from, to, &bytes);
  return bytes;
}

std::string MeshBytes(const Mesh& mesh) {
  std::string bytes;
  AppendBytes(mesh.positions, 0, mesh.positions.size(), &bytes);
  AppendBytes(mesh.normals, 0, mesh.normals.size(), &bytes);
  AppendBytes(mesh.uvs, 0, mesh.uvs.size(), &bytes);
  AppendBytes(mesh.indices, 0, mesh.indices.size(), &bytes);
  AppendBytes(mesh.colors, 0, mesh.colors.size(), &bytes);
  return bytes;
}

}  // namespace terrane::core
