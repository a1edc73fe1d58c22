// GltfColumns: the binary half of a glTF file: columns of numbers one after the
// other in one buffer, and the views and accessors that describe them.
//
// Columns are referred to, not copied, until AppendTo writes them: whoever adds
// one keeps it alive. Every column starts at a whole word. Belongs to one
// thread; the same columns give the same bytes.
#ifndef TERRANE_CORE_CODEC_GLTF_COLUMNS_H_
#define TERRANE_CORE_CODEC_GLTF_COLUMNS_H_

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/scene.h"

namespace terrane::core {

class GltfColumns {
 public:
  using Json = nlohmann::ordered_json;

  // Each answers the index of the column's accessor.
  std::size_t AddVertices(const std::vector<Float2>& column);
  std::size_t AddVertices(const std::vector<Float3>& column);
  // With the bounds that positions must have; not empty.
  std::size_t AddPositions(const std::vector<Float3>& column);
  // As 16-bit numbers where a mesh has fewer than 65,535 vertices.
  std::size_t AddIndices(const std::vector<std::uint32_t>& indices,
                         std::size_t vertices);
  // What the instances of a mesh have, which is not for a vertex buffer.
  std::size_t AddOfInstances(const std::vector<Float3>& column);
  std::size_t AddOfInstances(const std::vector<Quaternion>& column);

  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }
  // Of all columns, a multiple of 4.
  std::size_t bytes() const { return bytes_; }
  void AppendTo(std::string* file) const;

 private:
  // A run of the buffer: bytes as they lie in memory, or numbers to narrow.
  struct Part {
    std::span<const std::byte> bytes;
    std::span<const std::uint32_t> narrowed;
  };

  template <typename Value>
  std::size_t AddColumn(const std::vector<Value>& column, const char* type,
                        int target);
  std::size_t AddPart(const Part& part, std::size_t part_bytes,
                      std::size_t count, int component_type, const char* type,
                      int target);

  std::vector<Part> parts_;
  std::size_t bytes_ = 0;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_GLTF_COLUMNS_H_
