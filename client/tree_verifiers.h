// Verifiers of the streams of TreeService: every block is held against what
// must come, so that nothing wrong reaches a file: order, sizes of columns,
// checksums, parents before their children.
//
// Each belongs to one stream and one thread. Errors: DATA_LOSS, naming what
// came and what was expected; FAILED_PRECONDITION when a resumed stream is
// another's.
#ifndef TERRANE_CLIENT_TREE_VERIFIERS_H_
#define TERRANE_CLIENT_TREE_VERIFIERS_H_

#include <cstdint>

#include "absl/status/status.h"
#include "terrane/v1/tree.pb.h"

namespace terrane::client {

class TreeStreamVerifier {
 public:
  // The header of the stream, or of its resumption: that one must announce the
  // same tree.
  absl::Status CheckHeader(const v1::TreeHeader& header);
  bool has_header() const { return has_header_; }
  // The end of the stream.
  absl::Status CheckEnd() const;
  // Index of what must come next, a row, a leaf, a block or a tree: where to
  // resume.
  std::int64_t next_index() const { return next_index_; }

 protected:
  explicit TreeStreamVerifier(std::int64_t first) : next_index_(first) {}
  ~TreeStreamVerifier() = default;

  const v1::TreeHeader& header() const { return header_; }

  std::int64_t next_index_;

 private:
  v1::TreeHeader header_;
  bool has_header_ = false;
};

class TreeRowsVerifier : public TreeStreamVerifier {
 public:
  explicit TreeRowsVerifier(const v1::StreamTreeRequest& request)
      : TreeStreamVerifier(request.from_row()) {}

  absl::Status CheckTile(const v1::SegmentRows& rows);
};

class TreeLeavesVerifier : public TreeStreamVerifier {
 public:
  explicit TreeLeavesVerifier(const v1::StreamTreeLeavesRequest& request)
      : TreeStreamVerifier(request.from_leaf()) {}

  absl::Status CheckTile(const v1::LeafRows& leaves);
};

class TubesVerifier : public TreeStreamVerifier {
 public:
  explicit TubesVerifier(const v1::StreamTreeMeshRequest& request)
      : TreeStreamVerifier(request.first_block()) {}

  absl::Status CheckTile(const v1::TubeBlock& block);
};

class ForestVerifier : public TreeStreamVerifier {
 public:
  explicit ForestVerifier(const v1::StreamForestRequest& request);

  // A resumed stream begins a tree again: blocks of it that came before are
  // checked once more, and IsRepeat() then says so.
  absl::Status CheckHeader(const v1::TreeHeader& header);
  absl::Status CheckTile(const v1::ForestBlock& block);
  bool IsRepeat() const { return is_repeat_; }
  absl::Status CheckEnd() const;

 private:
  const std::int64_t trees_;
  // Of the tree in hand.
  std::int64_t next_row_ = 0;
  std::int64_t next_leaf_ = 0;
  std::int64_t blocks_ = 0;
  // Blocks of it that had come when the stream was cut.
  std::int64_t blocks_before_ = 0;
  bool is_repeat_ = false;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TREE_VERIFIERS_H_
