// The rows of trees put together again, for tests.
#ifndef TERRANE_TESTS_SERVER_TREE_RUNS_H_
#define TERRANE_TESTS_SERVER_TREE_RUNS_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "terrane/v1/tree.pb.h"
#include "tests/server/read_all.h"

namespace terrane::server {

// The rows of messages as columns, whatever blocks they came in.
struct TreeColumns {
  std::string parents, starts, ends, radii, flags, attaches, chromosomes,
      extensions;
  std::vector<std::int64_t> generation_ends;
  std::int64_t rows = 0;

  void Add(const v1::SegmentRows& block) {
    EXPECT_EQ(block.first_row(), first_row + rows);
    rows += block.rows();
    parents += block.parents();
    starts += block.starts();
    ends += block.ends();
    radii += block.radius_starts() + block.radius_ends();
    flags += block.flags();
    attaches += block.attaches();
    chromosomes += block.chromosomes();
    extensions += block.extensions();
    for (const v1::GenerationMark& mark : block.marks()) {
      generation_ends.push_back(mark.end_row());
    }
  }

  std::int64_t first_row = 0;
};

inline TreeColumns ColumnsOf(
    const std::vector<v1::StreamTreeResponse>& messages,
    std::int64_t first_row = 0) {
  TreeColumns columns;
  columns.first_row = first_row;
  for (const v1::StreamTreeResponse& message : messages) {
    if (message.has_segments()) columns.Add(message.segments());
  }
  return columns;
}

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_TREE_RUNS_H_
