#include "core/codec/gltf_columns.h"

#include <algorithm>
#include <bit>

namespace terrane::core {
namespace {

static_assert(std::endian::native == std::endian::little,
              "columns are copied as they lie in memory");

// Constants of the glTF 2.0 specification.
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kNoTarget = 0;

// 65,535 itself is not an index of 16 bits: it restarts a strip.
constexpr std::size_t kNarrowVertices = 65'535;

constexpr std::size_t WholeWords(std::size_t bytes) {
  return (bytes + 3) / 4 * 4;
}

}  // namespace

std::size_t GltfColumns::AddPart(const Part& part, std::size_t part_bytes,
                                 std::size_t count, int component_type,
                                 const char* type, int target) {
  GltfColumns::Json view = {
      {"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", part_bytes}};
  if (target != kNoTarget) view["target"] = target;
  views_.push_back(std::move(view));
  accessors_.push_back({{"bufferView", views_.size() - 1},
                        {"componentType", component_type},
                        {"count", count},
                        {"type", type}});
  parts_.push_back(part);
  bytes_ += WholeWords(part_bytes);
  return accessors_.size() - 1;
}

template <typename Value>
std::size_t GltfColumns::AddColumn(const std::vector<Value>& column,
                                   const char* type, int target) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(column));
  return AddPart({bytes, {}}, bytes.size(), column.size(), kFloat, type,
                 target);
}

std::size_t GltfColumns::AddVertices(const std::vector<Float2>& column) {
  return AddColumn(column, "VEC2", kArrayBuffer);
}

std::size_t GltfColumns::AddVertices(const std::vector<Float3>& column) {
  return AddColumn(column, "VEC3", kArrayBuffer);
}

std::size_t GltfColumns::AddPositions(const std::vector<Float3>& column) {
  const std::size_t accessor = AddVertices(column);
  Float3 low = column.front();
  Float3 high = low;
  for (const Float3& p : column) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y),
            std::max(high.z, p.z)};
  }
  accessors_[accessor]["min"] = {low.x, low.y, low.z};
  accessors_[accessor]["max"] = {high.x, high.y, high.z};
  return accessor;
}

std::size_t GltfColumns::AddIndices(const std::vector<std::uint32_t>& indices,
                                    std::size_t vertices) {
  if (vertices < kNarrowVertices) {
    return AddPart({{}, indices}, indices.size() * sizeof(std::uint16_t),
                   indices.size(), kUnsignedShort, "SCALAR",
                   kElementArrayBuffer);
  }
  const std::span<const std::byte> bytes = std::as_bytes(std::span(indices));
  return AddPart({bytes, {}}, bytes.size(), indices.size(), kUnsignedInt,
                 "SCALAR", kElementArrayBuffer);
}

std::size_t GltfColumns::AddOfInstances(const std::vector<Float3>& column) {
  return AddColumn(column, "VEC3", kNoTarget);
}

std::size_t GltfColumns::AddOfInstances(const std::vector<Quaternion>& column) {
  static_assert(sizeof(Quaternion) == 4 * sizeof(float));
  return AddColumn(column, "VEC4", kNoTarget);
}

void GltfColumns::AppendTo(std::string* file) const {
  for (const Part& part : parts_) {
    const std::size_t start = file->size();
    file->append(reinterpret_cast<const char*>(part.bytes.data()),
                 part.bytes.size());
    for (const std::uint32_t number : part.narrowed) {
      file->push_back(static_cast<char>(number & 0xFF));
      file->push_back(static_cast<char>(number >> 8 & 0xFF));
    }
    file->resize(start + WholeWords(file->size() - start), '\0');
  }
}

}  // namespace terrane::core
