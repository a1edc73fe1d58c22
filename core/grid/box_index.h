// A static index of boxes: which of them touch a given box.
//
// Packed once (Boost.Geometry's R-tree); queries take logarithmic time plus
// what they find. Immutable and thread-safe.
#ifndef TERRANE_CORE_GRID_BOX_INDEX_H_
#define TERRANE_CORE_GRID_BOX_INDEX_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/grid/sample_rect.h"

namespace terrane::core {

class BoxIndex {
 public:
  // Box i has id i. Bounds are not NaN; they may be infinite.
  explicit BoxIndex(std::span<const Box> boxes);
  ~BoxIndex();
  BoxIndex(BoxIndex&&) noexcept;
  BoxIndex& operator=(BoxIndex&&) noexcept;

  // Replaces `ids` by the ids of the boxes that touch `box`, borders included,
  // ascending, and returns true; or returns false, `ids` being of no use, as
  // soon as there are more than `most`.
  bool Query(const Box& box, std::size_t most,
             std::vector<std::uint32_t>* ids) const;

 private:
  class Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_BOX_INDEX_H_
