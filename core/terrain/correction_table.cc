#include "core/terrain/correction_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/noise/counter_hash.h"

namespace terrane::core {
namespace {

// Buckets are 2^kBucketBits indices a side.
constexpr int kBucketBits = 5;
constexpr std::int64_t kBucketMask = (1 << kBucketBits) - 1;

struct BucketKey {
  std::int64_t y, x;
  auto operator<=>(const BucketKey&) const = default;
};

BucketKey KeyOf(const LatticePoint& point) {
  return {point.y >> kBucketBits, point.x >> kBucketBits};
}

struct KeyHash {
  std::size_t operator()(const BucketKey& key) const {
    return Mix64(Mix64(static_cast<std::uint64_t>(key.x)) ^
                 static_cast<std::uint64_t>(key.y));
  }
};

// Place in the bucket: row and column, 5 bits each.
std::uint16_t PlaceOf(const LatticePoint& point) {
  return static_cast<std::uint16_t>(((point.y & kBucketMask) << kBucketBits) |
                                    (point.x & kBucketMask));
}

// The mirror images of `index` within kBeyondBorder of [0, last]; itself first.
std::vector<std::int64_t> Images(std::int64_t index, std::int64_t last) {
  std::vector<std::int64_t> images = {index};
  for (std::int64_t k = 1; k <= CorrectionTable::kBeyondBorder; ++k) {
    for (const std::int64_t outside : {-k, last + k}) {
      if (Reflect(outside, last) == index) images.push_back(outside);
    }
  }
  return images;
}

}  // namespace

struct CorrectionTable::Bucket {
  BucketKey key;
  std::uint64_t first = 0;  // of its entries; they end where the next begins
};

struct CorrectionTable::Slot {
  // Sorted by key; the last one is a sentinel that only ends the entries.
  std::vector<Bucket> buckets;
  std::vector<std::uint16_t> places;
  std::vector<float> values;
};

struct CorrectionTable::Builder::Slot {
  // Entries announced, then where the next one goes.
  std::unordered_map<BucketKey, std::uint64_t, KeyHash> counts;
  // The bucket of the last entry: neighbours come one after the other.
  BucketKey last_key = {0, 0};
  std::uint64_t* last = nullptr;
  CorrectionTable::Slot table;

  std::uint64_t* Find(const BucketKey& key) {
    if (last == nullptr || key != last_key) {
      last_key = key;
      last = &counts[key];
    }
    return last;
  }
};

CorrectionTable::CorrectionTable() = default;
CorrectionTable::~CorrectionTable() = default;
CorrectionTable::CorrectionTable(CorrectionTable&&) noexcept = default;
CorrectionTable& CorrectionTable::operator=(CorrectionTable&&) noexcept =
    default;

// --- Building ---------------------------------------------------------------

CorrectionTable::Builder::Builder(Mirror mirror, int dimensions)
    : mirror_(mirror), dimensions_(dimensions) {}

CorrectionTable::Builder::~Builder() = default;

template <typename Visit>
void CorrectionTable::Builder::ForEachImage(int level, LatticePoint point,
                                            const Visit& visit) const {
  const auto far = [&](std::int64_t index, std::int64_t cells) {
    return index > kBeyondBorder && (cells << level) - index > kBeyondBorder;
  };
  if (!mirror_.domain || (far(point.x, mirror_.domain->cells_x) &&
                          far(point.y, mirror_.domain->cells_y))) {
    visit(point);
    return;
  }
  for (const std::int64_t x :
       Images(point.x, mirror_.domain->cells_x << level)) {
    if (dimensions_ == 1) {
      visit(LatticePoint{x, 0});
      continue;
    }
    for (const std::int64_t y :
         Images(point.y, mirror_.domain->cells_y << level)) {
      visit(LatticePoint{x, y});
    }
  }
}

void CorrectionTable::Builder::Announce(std::uint32_t slot, int level,
                                        LatticePoint point) {
  if (slots_.size() <= slot) slots_.resize(slot + 1);
  ForEachImage(level, point, [&](const LatticePoint& image) {
    ++*slots_[slot].Find(KeyOf(image));
  });
}

void CorrectionTable::Builder::Allocate() {
  for (Slot& slot : slots_) {
    std::vector<Bucket>& buckets = slot.table.buckets;
    for (const auto& [key, count] : slot.counts) buckets.push_back({key, 0});
    std::sort(buckets.begin(), buckets.end(),
              [](const Bucket& a, const Bucket& b) { return a.key < b.key; });
    std::uint64_t next = 0;
    for (Bucket& bucket : buckets) {
      bucket.first = next;
      std::uint64_t& place = slot.counts[bucket.key];
      next += std::exchange(place, next);
    }
    constexpr std::int64_t kBehindAll =
        std::numeric_limits<std::int64_t>::max();
    buckets.push_back({{kBehindAll, kBehindAll}, next});
    slot.table.places.resize(next);
    slot.table.values.resize(next);
  }
}

void CorrectionTable::Builder::Add(std::uint32_t slot, int level,
                                   LatticePoint point, float value) {
  if (std::fabs(value) < kLeastValue) return;
  ForEachImage(level, point, [&](const LatticePoint& image) {
    const std::uint64_t at = (*slots_[slot].Find(KeyOf(image)))++;
    slots_[slot].table.places[at] = PlaceOf(image);
    slots_[slot].table.values[at] = value;
  });
}

CorrectionTable CorrectionTable::Builder::Build() && {
  CorrectionTable result;
  for (Slot& slot : slots_) {
    // Closes the gaps that entries left out have made.
    std::uint64_t next = 0;
    for (Bucket& bucket : slot.table.buckets) {
      const auto filled = slot.counts.find(bucket.key);
      const std::uint64_t end =
          filled == slot.counts.end() ? bucket.first : filled->second;
      const std::uint64_t first = std::exchange(bucket.first, next);
      for (std::uint64_t k = first; k < end; ++k, ++next) {
        slot.table.places[next] = slot.table.places[k];
        slot.table.values[next] = slot.table.values[k];
      }
    }
    slot.table.places.resize(next);
    slot.table.places.shrink_to_fit();
    slot.table.values.resize(next);
    slot.table.values.shrink_to_fit();
    slot.counts.clear();
    result.slots_.push_back(std::move(slot.table));
  }
  return result;
}

// --- Reading ----------------------------------------------------------------

std::int64_t CorrectionTable::MemoryBytes() const {
  std::size_t bytes = 0;
  for (const Slot& slot : slots_) {
    bytes += slot.buckets.size() * sizeof(Bucket) +
             slot.values.size() * (sizeof(float) + sizeof(std::uint16_t));
  }
  return static_cast<std::int64_t>(bytes);
}

void CorrectionTable::AddTo(std::uint32_t slot_id, std::int64_t x,
                            std::int64_t y, std::int64_t spacing, int columns,
                            int rows, GridView plane) const {
  if (slot_id >= slots_.size() || slots_[slot_id].values.empty()) return;
  const Slot& slot = slots_[slot_id];
  const std::int64_t width = spacing * columns;
  const std::int64_t height = spacing * rows;
  const BucketKey first = KeyOf({x, y});
  const BucketKey last = KeyOf({x + width - 1, y + height - 1});
  auto bucket = slot.buckets.begin();
  for (std::int64_t row = first.y; row <= last.y; ++row) {
    bucket = std::lower_bound(
        bucket, slot.buckets.end() - 1, BucketKey{row, first.x},
        [](const Bucket& b, const BucketKey& key) { return b.key < key; });
    for (; bucket->key.y == row && bucket->key.x <= last.x; ++bucket) {
      AddBucket(slot, bucket - slot.buckets.begin(), x, y, spacing, columns,
                rows, plane);
    }
  }
}

void CorrectionTable::AddBucket(const Slot& slot, std::ptrdiff_t index,
                                std::int64_t x, std::int64_t y,
                                std::int64_t spacing, int columns, int rows,
                                GridView plane) {
  const Bucket* bucket = &slot.buckets[static_cast<std::size_t>(index)];
  const std::int64_t width = spacing * columns;
  const std::int64_t height = spacing * rows;
  const std::int64_t dx = (bucket->key.x << kBucketBits) - x;
  const std::int64_t dy = (bucket->key.y << kBucketBits) - y;
  const int shift = spacing == 1 ? 0 : 1;
  // Most buckets of a tile lie inside it, and all of their points are its own.
  const bool inside = dx >= 0 && dy >= 0 && dx + kBucketMask < width &&
                      dy + kBucketMask < height && spacing == 1;
  for (std::uint64_t k = bucket->first; k < bucket[1].first; ++k) {
    const std::int64_t i = dx + (slot.places[k] & kBucketMask);
    const std::int64_t j = dy + (slot.places[k] >> kBucketBits);
    if (!inside) {
      if (i < 0 || i >= width || j < 0 || j >= height) continue;
      if (((i | j) & (spacing - 1)) != 0) continue;
    }
    plane.At(i >> shift, j >> shift) += slot.values[k];
  }
}

}  // namespace terrane::core
