#include "core/codec/swc.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/codec/number_text.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

constexpr std::int64_t kRoot = -1;

// The lines of one tree.
class SwcWriter {
 public:
  // Ids go on from `*nodes`.
  SwcWriter(const SegmentBlock& tree, std::int64_t* nodes)
      : tree_(tree),
        nodes_(*nodes),
        children_(tree.rows()),
        joint_of_(tree.rows(), kRoot) {
    for (std::size_t row = 0; row < tree.rows(); ++row) {
      if (tree.parent[row] != kNoParent) {
        children_[tree.parent[row]].push_back(row);
      }
    }
  }

  std::string Write() {
    for (std::size_t row = 0; row < tree_.rows(); ++row) WriteRow(row);
    return std::move(text_);
  }

 private:
  void WriteRow(std::size_t row) {
    std::vector<std::size_t>& children = children_[row];
    std::stable_sort(children.begin(), children.end(),
                     [&](std::size_t a, std::size_t b) {
                       return tree_.attach[a] < tree_.attach[b];
                     });
    const Float3 start = tree_.start[row];
    const Float3 along = tree_.end[row] - start;
    const float radius = tree_.radius_start[row];
    const float growth = tree_.radius_end[row] - radius;
    std::int64_t last = Node(kSwcStart, start, radius, joint_of_[row]);
    float reached = 0;
    for (const std::size_t child : children) {
      const float at = tree_.attach[child];
      if (at >= 1) break;
      if (at > reached) {
        last = Node(kSwcJoint, start + at * along, radius + at * growth, last);
        reached = at;
      }
      joint_of_[child] = last;
    }
    last = Node(kSwcEnd, tree_.end[row], tree_.radius_end[row], last);
    for (const std::size_t child : children) {
      if (tree_.attach[child] >= 1) joint_of_[child] = last;
    }
  }

  // Writes a node and gives its id.
  std::int64_t Node(int type, Float3 p, float radius, std::int64_t parent) {
    const std::int64_t id = ++nodes_;
    AppendNumber(id, &text_);
    AppendNumber(' ', type, &text_);
    for (const float number : {p.x, p.y, p.z, radius}) {
      AppendNumber(' ', number, &text_);
    }
    AppendNumber(' ', parent, &text_);
    text_.push_back('\n');
    return id;
  }

  const SegmentBlock& tree_;
  std::int64_t& nodes_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<std::int64_t> joint_of_;  // the node that a row hangs on
  std::string text_;
};

}  // namespace

std::string EncodeSwc(const SegmentBlock& tree) {
  return SwcForest::Header() + SwcForest().Add(tree);
}

std::string SwcForest::Header() { return "# id type x y z radius parent\n"; }

std::string SwcForest::Add(const SegmentBlock& tree) {
  return SwcWriter(tree, &nodes_).Write();
}

}  // namespace terrane::core
