// The sparse table of corrections: what is added to the displacements of a few
// lattice points, by half step and index.
//
// Conditioning (core/terrain/conditioning.h) fills it once; every tile adds
// what lies inside it. Entries are kept in square buckets of 32 x 32 indices,
// six bytes each, so that a window finds its own in a few steps and reads them
// one after the other.
//
// Immutable and thread-safe. Determinism: an entry is added to its own point,
// whatever the window.
#ifndef TERRANE_CORE_TERRAIN_CORRECTION_TABLE_H_
#define TERRANE_CORE_TERRAIN_CORRECTION_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/grid_view.h"
#include "core/terrain/discrete_constraints.h"
#include "core/terrain/mirror.h"

namespace terrane::core {

class CorrectionTable {
 public:
  // How far beyond a bounded domain a window of the lattice can reach; entries
  // near the border are kept mirrored that far.
  static constexpr std::int64_t kBeyondBorder = 16;

  // Entries smaller than this (sigma = 1) are left out: no float of P's size
  // holds them.
  static constexpr float kLeastValue = 0x1p-32f;

  // Filled in two passes, so that 10^8 entries never exist twice: every point
  // is announced, then, after Allocate, added. The passes may differ in order.
  class Builder {
   public:
    // A line has one row.
    Builder(Mirror mirror, int dimensions);
    ~Builder();

    // A point of half step `slot` (HalfStepSlot) of `level`. Several entries
    // may fall on one point: they add up.
    void Announce(std::uint32_t slot, int level, LatticePoint point);
    void Allocate();
    void Add(std::uint32_t slot, int level, LatticePoint point, float value);

    // What was announced must have been added.
    CorrectionTable Build() &&;

   private:
    friend class CorrectionTable;
    struct Slot;
    template <typename Visit>
    void ForEachImage(int level, LatticePoint point, const Visit& visit) const;

    Mirror mirror_;
    int dimensions_;
    std::vector<Slot> slots_;
  };

  CorrectionTable();
  ~CorrectionTable();
  CorrectionTable(CorrectionTable&&) noexcept;
  CorrectionTable& operator=(CorrectionTable&&) noexcept;

  bool empty() const { return slots_.empty(); }
  std::int64_t MemoryBytes() const;

  // plane(i, j) += the entry of point (x + spacing i, y + spacing j), spacing 1
  // or 2; entries of other points are left alone.
  void AddTo(std::uint32_t slot, std::int64_t x, std::int64_t y,
             std::int64_t spacing, int columns, int rows, GridView plane) const;

 private:
  struct Bucket;
  struct Slot;
  static void AddBucket(const Slot& slot, std::ptrdiff_t index, std::int64_t x,
                        std::int64_t y, std::int64_t spacing, int columns,
                        int rows, GridView plane);

  std::vector<Slot> slots_;  // by slot; none behind the last used
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_CORRECTION_TABLE_H_
