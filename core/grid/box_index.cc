#include "core/grid/box_index.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <utility>

namespace terrane::core {
namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;

using TreePoint = bg::model::point<double, 2, bg::cs::cartesian>;
using TreeBox = bg::model::box<TreePoint>;
using Entry = std::pair<TreeBox, std::uint32_t>;
using Tree = bgi::rtree<Entry, bgi::rstar<16>>;

// The tree packs by centres and areas, which infinity would make NaN.
constexpr double kFarthest = 1e100;

TreePoint MakePoint(double x, double y) {
  return {std::clamp(x, -kFarthest, kFarthest),
          std::clamp(y, -kFarthest, kFarthest)};
}

TreeBox MakeBox(const Box& box) {
  return {MakePoint(box.min_x, box.min_y), MakePoint(box.max_x, box.max_y)};
}

std::vector<Entry> MakeEntries(std::span<const Box> boxes) {
  std::vector<Entry> entries;
  entries.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    entries.emplace_back(MakeBox(boxes[i]), static_cast<std::uint32_t>(i));
  }
  return entries;
}

// An output iterator that keeps the ids of the entries it is given.
class IdCollector {
 public:
  using iterator_category = std::output_iterator_tag;
  using value_type = void;
  using difference_type = std::ptrdiff_t;
  using pointer = void;
  using reference = void;

  explicit IdCollector(std::vector<std::uint32_t>* ids) : ids_(ids) {}

  IdCollector& operator=(const Entry& entry) {
    ids_->push_back(entry.second);
    return *this;
  }
  IdCollector& operator*() { return *this; }
  IdCollector& operator++() { return *this; }
  IdCollector& operator++(int) { return *this; }

 private:
  std::vector<std::uint32_t>* ids_;
};

}  // namespace

class BoxIndex::Impl {
 public:
  explicit Impl(std::span<const Box> boxes) : tree_(MakeEntries(boxes)) {}

  const Tree& tree() const { return tree_; }

 private:
  Tree tree_;
};

BoxIndex::BoxIndex(std::span<const Box> boxes)
    : impl_(std::make_unique<Impl>(boxes)) {}
BoxIndex::~BoxIndex() = default;
BoxIndex::BoxIndex(BoxIndex&&) noexcept = default;
BoxIndex& BoxIndex::operator=(BoxIndex&&) noexcept = default;

bool BoxIndex::Query(const Box& box, std::size_t most,
                     std::vector<std::uint32_t>* ids) const {
  ids->clear();
  const TreeBox wanted = MakeBox(box);
  if (most >= impl_->tree().size()) {
    // Nothing to stop for: the plain query, which is the faster one.
    impl_->tree().query(bgi::intersects(wanted), IdCollector(ids));
    std::sort(ids->begin(), ids->end());
    return true;
  }
  const auto end = impl_->tree().qend();
  for (auto it = impl_->tree().qbegin(bgi::intersects(wanted)); it != end;
       ++it) {
    if (ids->size() == most) return false;
    ids->push_back(it->second);
  }
  std::sort(ids->begin(), ids->end());
  return true;
}

}  // namespace terrane::core
