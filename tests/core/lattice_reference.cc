#include "tests/core/lattice_reference.h"

#include "core/noise/counter_hash.h"
#include "core/noise/normal.h"
#include "core/terrain/displacement.h"

namespace terrane::core {
namespace {

std::int64_t ReflectInto(std::int64_t i, std::int64_t last) {
  while (i < 0 || i > last) i = i < 0 ? -i : 2 * last - i;
  return i;
}

bool Odd(std::int64_t i) { return (i & 1) != 0; }

}  // namespace

LatticeReference::LatticeReference(std::int64_t seed, FractalSource source,
                                   double roughness,
                                   std::optional<Domain> domain)
    : seed_(seed), source_(source), roughness_(roughness), domain_(domain) {}

void LatticeReference::Constrain(int level, std::int64_t x, std::int64_t y) {
  constrained_.insert({level, x, y});
}

std::int64_t LatticeReference::ReflectX(int level, std::int64_t x) const {
  return domain_ ? ReflectInto(x, domain_->cells_x << level) : x;
}

std::int64_t LatticeReference::ReflectY(int level, std::int64_t y) const {
  return domain_ ? ReflectInto(y, domain_->cells_y << level) : y;
}

bool LatticeReference::OnBorder(int level, std::int64_t x,
                                std::int64_t y) const {
  return domain_ && (x == 0 || x == domain_->cells_x << level || y == 0 ||
                     y == domain_->cells_y << level);
}

bool LatticeReference::Constrained(int level, std::int64_t x,
                                   std::int64_t y) const {
  return constrained_.contains({level, x, y});
}

float LatticeReference::Displacement(int level, int half, std::int64_t x,
                                     std::int64_t y) const {
  const auto stream = static_cast<std::uint32_t>(2 * level + half);
  const RowKey key = MakeRowKey(StreamKey(seed_, stream), ReflectY(level, y));
  const double deviation =
      level == 0 ? Level0Deviation(source_)
                 : DisplacementDeviation(
                       source_, 2, roughness_, level,
                       half == 0 ? HalfStep::kCentre : HalfStep::kEdge);
  return NormalFromBits(HashLane(ColumnWord(ReflectX(level, x)), key)) *
         static_cast<float>(deviation);
}

float LatticeReference::Buffer(int level, std::int64_t x, std::int64_t y) {
  float sum = 0;
  for (const auto& [at_level, px, py] : constrained_) {
    if (at_level != level - 1 || at_level == 0) continue;
    const std::int64_t dx = x - 2 * px;
    const std::int64_t dy = y - 2 * py;
    const bool centre = Odd(px) && Odd(py);
    const bool mine =
        centre ? dx * dx == 1 && dy * dy == 1 : dx * dx + dy * dy == 1;
    if (!mine) continue;
    const float share =
        !centre && OnBorder(at_level, px, py) ? -(1.0f / 3) : -0.25f;
    sum += Unconstrained(at_level, px, py) * share;
  }
  return sum;
}

float LatticeReference::Corner(int level, std::int64_t x, std::int64_t y) {
  float value = Point(level - 1, x / 2, y / 2);
  if (source_ == FractalSource::kSuccessive) {
    value += Displacement(level, 0, x, y);
  }
  return value;
}

float LatticeReference::Centre(int level, std::int64_t x, std::int64_t y) {
  const auto [at, fresh] = centres_.try_emplace({level, x, y}, 0.0f);
  if (!fresh) return at->second;
  const auto corner = [&](int i, int j) {
    return Point(level - 1, (x + i) / 2, (y + j) / 2);
  };
  float mean = 0;
  if (source_ == FractalSource::kSubdivision) {
    float rows[4];
    for (int b = 0; b < 4; ++b) {
      const int j = 2 * b - 3;
      rows[b] = (corner(-1, j) + corner(1, j)) * (9.0f / 16) -
                (corner(-3, j) + corner(3, j)) * (1.0f / 16);
    }
    mean =
        (rows[1] + rows[2]) * (9.0f / 16) - (rows[0] + rows[3]) * (1.0f / 16);
  } else {
    mean = ((corner(-1, -1) + corner(1, -1)) + (corner(-1, 1) + corner(1, 1))) *
           0.25f;
  }
  const float value = mean + Displacement(level, 0, x, y) + Buffer(level, x, y);
  centres_[{level, x, y}] = value;
  return value;
}

float LatticeReference::Edge(int level, std::int64_t x, std::int64_t y) {
  // Any parent: a corner where both indices are even, a centre where both are
  // odd.
  const auto at = [&](int i, int j) {
    return Odd(x + i) ? Centre(level, x + i, y + j)
                      : Corner(level, x + i, y + j);
  };
  // (i, j) runs along the edge from corner to corner, (k, l) across it.
  const bool horizontal = Odd(x);
  const auto pair = [&](int along, int across) {
    return horizontal ? at(-along, across) + at(along, across)
                      : at(across, -along) + at(across, along);
  };
  const auto across = [&](int distance) {
    return horizontal ? at(0, -distance) + at(0, distance)
                      : at(-distance, 0) + at(distance, 0);
  };
  const float noise = Displacement(level, 1, x, y);
  if (source_ != FractalSource::kSubdivision) {
    const bool on_column_border =
        domain_ && !horizontal && (x == 0 || x == domain_->cells_x << level);
    const bool on_row_border =
        domain_ && horizontal && (y == 0 || y == domain_->cells_y << level);
    if (on_column_border || on_row_border) {
      const int inside = (on_column_border ? x : y) == 0 ? 1 : -1;
      const float centre = on_column_border ? at(inside, 0) : at(0, inside);
      return (pair(1, 0) + centre) * (1.0f / 3) + noise + Buffer(level, x, y);
    }
    return (pair(1, 0) + across(1)) * 0.25f + noise + Buffer(level, x, y);
  }
  const float near = pair(1, 0) + across(1);
  const float far = pair(3, 0) + across(3);
  // The 8 points of weight -9: corners (1, +-2), centres (2, +-1). The kernel
  // adds left and right first, then up and down.
  const auto four = [&](int i, int j) {
    return (at(-i, -j) + at(i, -j)) + (at(-i, j) + at(i, j));
  };
  const float middle =
      horizontal ? four(1, 2) + four(2, 1) : four(2, 1) + four(1, 2);
  return near * (81.0f / 256) - middle * (9.0f / 256) + far * (1.0f / 256) +
         noise;
}

float LatticeReference::Unconstrained(int level, std::int64_t x,
                                      std::int64_t y) {
  const auto found = memo_.find({level, x, y});
  if (found != memo_.end()) return found->second;
  float value = 0;
  if (level == 0) {
    value = Displacement(0, 1, x, y);
  } else if (Odd(x) != Odd(y)) {
    value = Edge(level, x, y);
  } else {
    value = Odd(x) ? Centre(level, x, y) : Corner(level, x, y);
    if (source_ == FractalSource::kSuccessive) {
      value += Displacement(level, 1, x, y);
    }
  }
  memo_[{level, x, y}] = value;
  return value;
}

float LatticeReference::Point(int level, std::int64_t x, std::int64_t y) {
  x = ReflectX(level, x);
  y = ReflectY(level, y);
  return Constrained(level, x, y) ? 0.0f : Unconstrained(level, x, y);
}

float LatticeReference::Area(int level, std::int64_t x, std::int64_t y) {
  const std::int64_t cx = 2 * x + 1;
  const std::int64_t cy = 2 * y + 1;
  return Constrained(level + 1, cx, cy) ? 0.0f : Centre(level + 1, cx, cy);
}

}  // namespace terrane::core
