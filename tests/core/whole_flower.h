// A whole flower in one block, for tests.
#ifndef TERRANE_TESTS_CORE_WHOLE_FLOWER_H_
#define TERRANE_TESTS_CORE_WHOLE_FLOWER_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/flower/flower.h"
#include "core/flower/flower_generator.h"
#include "core/flower/instance_block.h"

namespace terrane::core {

// Fails the running test where the spec is not valid.
std::shared_ptr<const Flower> MakeFlower(const FlowerSpec& spec);

// Its rows from `from_row` on, gathered from blocks of `block_rows`.
InstanceBlock GrowRows(std::shared_ptr<const Flower> flower,
                       std::int64_t from_row = 0,
                       std::size_t block_rows = FlowerGenerator::kBlockRows);
InstanceBlock GrowRows(const FlowerSpec& spec);

// The bytes of rows [from, to) in all columns.
std::string RowBytes(const InstanceBlock& block, std::size_t from,
                     std::size_t to);

// The bytes of a mesh in all columns.
std::string MeshBytes(const Mesh& mesh);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_WHOLE_FLOWER_H_
