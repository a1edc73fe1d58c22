// A whole tree in one block, for tests.
#ifndef TERRANE_TESTS_CORE_WHOLE_TREE_H_
#define TERRANE_TESTS_CORE_WHOLE_TREE_H_

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/tree/tree_generator.h"
#include "gtest/gtest.h"

namespace terrane::core {

// Appends the rows and marks of `block`.
inline void Append(const SegmentBlock& block, SegmentBlock* whole) {
  const auto append = [](const auto& from, auto* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  if (whole->rows() == 0) {
    whole->first_row = block.first_row;
    whole->first_generation = block.first_generation;
  }
  append(block.parent, &whole->parent);
  append(block.start, &whole->start);
  append(block.end, &whole->end);
  append(block.radius_start, &whole->radius_start);
  append(block.radius_end, &whole->radius_end);
  append(block.flags, &whole->flags);
  append(block.attach, &whole->attach);
  append(block.chromosome, &whole->chromosome);
  append(block.extension, &whole->extension);
  append(block.marks, &whole->marks);
}

inline SegmentBlock Grow(std::shared_ptr<const Tree> tree,
                         std::int64_t from_row = 0, BlockSizes sizes = {}) {
  TreeGenerator generator(std::move(tree), from_row, sizes);
  SegmentBlock whole;
  SegmentBlock block;
  while (!generator.Done()) {
    const absl::Status status = generator.Next({}, &block);
    EXPECT_TRUE(status.ok()) << status;
    if (!status.ok()) break;
    Append(block, &whole);
  }
  return whole;
}

inline SegmentBlock Grow(const TreeSpec& spec) {
  const auto tree = Tree::Create(spec);
  EXPECT_TRUE(tree.ok()) << tree.status();
  return tree.ok() ? Grow(*tree) : SegmentBlock{};
}

inline std::vector<int> GenerationsOf(const SegmentBlock& block) {
  GenerationWalk walk(block);
  std::vector<int> generations;
  for (std::size_t i = 0; i < block.rows(); ++i) {
    generations.push_back(walk.At(i));
  }
  return generations;
}

// The columns of the first `rows` rows as bytes, one column after the other.
inline std::vector<std::string> ColumnBytes(const SegmentBlock& block,
                                            std::size_t rows) {
  std::vector<std::string> columns;
  const auto add = [&](const auto& column) {
    const std::size_t count = std::min(rows, column.size());
    columns.emplace_back(reinterpret_cast<const char*>(column.data()),
                         count * sizeof(column[0]));
  };
  add(block.parent);
  add(block.start);
  add(block.end);
  add(block.radius_start);
  add(block.radius_end);
  add(block.flags);
  add(block.attach);
  add(block.chromosome);
  add(block.extension);
  return columns;
}

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_WHOLE_TREE_H_
