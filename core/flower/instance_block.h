// InstanceBlock: rows of a flower's instances, as columns of one length.
//
// A vertex p of prototype `prototype` goes to translation + rotation * (scale *
// p), in metres. Rows are ordered by plant. A plain value; belongs to one
// thread at a time.
#ifndef TERRANE_CORE_FLOWER_INSTANCE_BLOCK_H_
#define TERRANE_CORE_FLOWER_INSTANCE_BLOCK_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/flower/flower_spec.h"
#include "core/mesh/mesh.h"
#include "core/mesh/scene.h"

namespace terrane::core {

struct FlowerInstance {
  std::uint32_t prototype = 0;
  Float3 translation;
  Quaternion rotation;
  Float3 scale = {1, 1, 1};
  FlowerOrgan organ = FlowerOrgan::kPetal;
  // Number in its group, from 1.
  std::uint32_t n = 0;
  std::uint32_t plant = 0;
};

struct InstanceBlock {
  std::int64_t first_row = 0;

  std::vector<std::uint32_t> prototype;
  std::vector<Float3> translation;
  std::vector<Quaternion> rotation;
  std::vector<Float3> scale;
  std::vector<FlowerOrgan> organ;
  std::vector<std::uint32_t> n;
  std::vector<std::uint32_t> plant;

  std::size_t rows() const { return prototype.size(); }
  void Clear();
  void Add(const FlowerInstance& instance);
};

// Bytes of a row in all columns.
inline constexpr std::int64_t kInstanceBytes = 53;

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_INSTANCE_BLOCK_H_
