#include "core/terrain/ancestor_weights.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace terrane::core {
namespace {

// Deslauriers-Dubuc weights of the points at -1.5, -0.5, 0.5, 1.5.
constexpr std::array<double, 4> kWeights = {-1.0 / 16, 9.0 / 16, 9.0 / 16,
                                            -1.0 / 16};
// The same places in half steps.
constexpr std::array<std::int64_t, 4> kPlaces = {-3, -1, 1, 3};

// Weights below this are dropped.
constexpr double kLeastWeight = 0x1p-24;

bool Odd(std::int64_t index) { return (index & 1) != 0; }

std::int64_t ReachOf(FractalSource source) {
  return source == FractalSource::kSubdivision ? 3 : 1;
}

LatticeBox Grown(const LatticeBox& box, std::int64_t by, bool in_y) {
  const int more = 2 * static_cast<int>(by);
  return {box.x - by, box.y - (in_y ? by : 0), box.columns + more,
          box.rows + (in_y ? more : 0)};
}

}  // namespace

AncestorWalk::AncestorWalk(FractalSource source, int dimensions, Mirror mirror)
    : source_(source),
      dimensions_(dimensions),
      mirror_(mirror),
      reach_(ReachOf(source)) {}

double AncestorWalk::Radius(FractalSource source) {
  // Both half steps of every finer level reach out, each level half as far:
  // 3 reaches in all, of which SUBDIVISION's outer ones weigh too little to
  // count.
  return source == FractalSource::kSubdivision ? 7.0 : 3.0;
}

double AncestorWalk::Separation(FractalSource source) {
  return source == FractalSource::kSubdivision ? 10.0 : 6.0;
}

void AncestorWalk::Start(int level, LatticePoint point) {
  level_ = level;
  started_ = false;
  given_.box = {point.x, point.y, 1, 1};
  given_.values.assign(1, 1.0);
}

bool AncestorWalk::Next(std::vector<Ancestor>* ancestors) {
  ancestors->clear();
  if (started_ && level_ == 0) return false;
  if (started_) --level_;
  started_ = true;
  if (level_ == 0) {
    Level0(ancestors);
    return true;
  }
  OpenLevel();
  if (dimensions_ == 1) {
    Line(ancestors);
  } else {
    Edges(ancestors);
    Centres(ancestors);
  }
  CloseLevel();
  return true;
}

void AncestorWalk::Level0(std::vector<Ancestor>* ancestors) {
  box_ = given_.box;
  for (int j = 0; j < box_.rows; ++j) {
    for (int i = 0; i < box_.columns; ++i) {
      const double weight =
          given_.values[static_cast<std::size_t>(j * box_.columns + i)];
      if (weight == 0) continue;
      ancestors->push_back({HalfStep::kEdge, {box_.x + i, box_.y + j}, weight});
    }
  }
}

// --- The level in hand ------------------------------------------------------

// Moves what was given into a box with room for both half steps around it.
void AncestorWalk::OpenLevel() {
  const std::int64_t room = (dimensions_ == 1 ? 1 : 2) * reach_;
  work_.box = Grown(given_.box, room, dimensions_ == 2);
  work_.values.assign(static_cast<std::size_t>(work_.box.columns) *
                          static_cast<std::size_t>(work_.box.rows),
                      0.0);
  for (int j = 0; j < given_.box.rows; ++j) {
    std::copy_n(&given_.values[static_cast<std::size_t>(j) *
                               static_cast<std::size_t>(given_.box.columns)],
                given_.box.columns,
                &work_.values[IndexOf(given_.box.x, given_.box.y + j)]);
  }
  box_ = work_.box;
  columns_.clear();
  for (int i = 0; i < box_.columns; ++i) {
    columns_.push_back(
        static_cast<std::size_t>(mirror_.X(box_.x + i, level_) - box_.x));
  }
  row_starts_.clear();
  for (int j = 0; j < box_.rows; ++j) {
    const std::int64_t y =
        dimensions_ == 2 ? mirror_.Y(box_.y + j, level_) : box_.y;
    row_starts_.push_back(static_cast<std::size_t>(y - box_.y) *
                          static_cast<std::size_t>(box_.columns));
  }
  inside_ = !mirror_.domain ||
            (box_.x >= 0 &&
             box_.x + box_.columns - 1 <= mirror_.domain->cells_x << level_ &&
             box_.y >= 0 &&
             box_.y + box_.rows - 1 <= mirror_.domain->cells_y << level_);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      const std::size_t k = 4 * a + b;
      const double weight = kWeights[a] * kWeights[b];
      // The 4 x 4 points of the lattice turned by 45 degrees, and of the
      // square one.
      edge_taps_.weights[k] = centre_taps_.weights[k] = weight;
      edge_taps_.steps[k] = (kPlaces[a] - kPlaces[b]) / 2 * work_.box.columns +
                            (kPlaces[a] + kPlaces[b]) / 2;
      centre_taps_.steps[k] = kPlaces[b] * work_.box.columns + kPlaces[a];
    }
  }
}

// What the corners have now is what the next coarser level is given: the
// smallest box that holds every weight.
void AncestorWalk::CloseLevel() {
  std::int64_t x0 = box_.x + box_.columns;
  std::int64_t y0 = box_.y + box_.rows;
  std::int64_t x1 = box_.x;
  std::int64_t y1 = box_.y;
  const std::int64_t even_x = box_.x + (box_.x & 1);
  for (std::int64_t y = box_.y + (box_.y & 1); y < box_.y + box_.rows; y += 2) {
    for (std::int64_t x = even_x; x < box_.x + box_.columns; x += 2) {
      if (std::fabs(work_.values[IndexOf(x, y)]) < kLeastWeight) continue;
      x0 = std::min(x0, x);
      y0 = std::min(y0, y);
      x1 = std::max(x1, x);
      y1 = std::max(y1, y);
    }
  }
  given_.box = {x0 / 2, y0 / 2, static_cast<int>((x1 - x0) / 2) + 1,
                static_cast<int>((y1 - y0) / 2) + 1};
  given_.values.clear();
  for (std::int64_t y = y0; y <= y1; y += 2) {
    for (std::int64_t x = x0; x <= x1; x += 2) {
      const double weight = work_.values[IndexOf(x, y)];
      given_.values.push_back(std::fabs(weight) < kLeastWeight ? 0.0 : weight);
    }
  }
}

// A point beyond the border is its mirror image: what is given to it goes
// there.
void AncestorWalk::Add(std::int64_t x, std::int64_t y, double weight) {
  work_.values[row_starts_[static_cast<std::size_t>(y - work_.box.y)] +
               columns_[static_cast<std::size_t>(x - work_.box.x)]] += weight;
}

void AncestorWalk::AddAll(const Taps& taps, std::int64_t x, std::int64_t y,
                          double weight) {
  double* here = &work_.values[IndexOf(x, y)];
  for (std::size_t k = 0; k < taps.steps.size(); ++k) {
    here[taps.steps[k]] += weight * taps.weights[k];
  }
}

// --- Half steps, transposed -------------------------------------------------

bool AncestorWalk::OnBorder(std::int64_t x, std::int64_t y) const {
  if (!mirror_.domain) return false;
  return x == 0 || x == mirror_.domain->cells_x << level_ || y == 0 ||
         y == mirror_.domain->cells_y << level_;
}

void AncestorWalk::PushEdge(std::int64_t x, std::int64_t y, double weight) {
  if (source_ == FractalSource::kSubdivision) {
    if (inside_) return AddAll(edge_taps_, x, y, weight);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        Add(x + (kPlaces[a] + kPlaces[b]) / 2,
            y + (kPlaces[a] - kPlaces[b]) / 2,
            weight * (kWeights[a] * kWeights[b]));
      }
    }
    return;
  }
  if (OnBorder(x, y)) {
    PushBorderEdge(x, y, weight);
    return;
  }
  for (const std::int64_t side : {-1, 1}) {
    Add(x + side, y, weight * 0.25);
    Add(x, y + side, weight * 0.25);
  }
}

// On the border M = 3: the centre outside is no parent.
void AncestorWalk::PushBorderEdge(std::int64_t x, std::int64_t y,
                                  double weight) {
  constexpr double kThird = 1.0f / 3;  // as the lattice has it
  for (const std::int64_t side : {-1, 1}) {
    if (mirror_.X(x + side, level_) == x + side) {
      Add(x + side, y, weight * kThird);
    }
    if (mirror_.Y(y + side, level_) == y + side) {
      Add(x, y + side, weight * kThird);
    }
  }
}

void AncestorWalk::PushCentre(std::int64_t x, std::int64_t y, double weight) {
  if (source_ == FractalSource::kSubdivision) {
    if (inside_) return AddAll(centre_taps_, x, y, weight);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        Add(x + kPlaces[a], y + kPlaces[b],
            weight * (kWeights[a] * kWeights[b]));
      }
    }
    return;
  }
  for (const std::int64_t dx : {-1, 1}) {
    for (const std::int64_t dy : {-1, 1}) Add(x + dx, y + dy, weight * 0.25);
  }
}

void AncestorWalk::Edges(std::vector<Ancestor>* ancestors) {
  const LatticeBox& box = given_.box;
  const bool all = source_ == FractalSource::kSuccessive;
  for (std::int64_t y = box.y; y < box.y + box.rows; ++y) {
    for (std::int64_t x = box.x; x < box.x + box.columns; ++x) {
      const double weight = given_.values[static_cast<std::size_t>(
          (y - box.y) * box.columns + (x - box.x))];
      if (weight == 0) continue;
      const bool edge = Odd(x) != Odd(y);
      if (edge || all) ancestors->push_back({HalfStep::kEdge, {x, y}, weight});
      if (edge) PushEdge(x, y, weight);
    }
  }
}

void AncestorWalk::Centres(std::vector<Ancestor>* ancestors) {
  const LatticeBox box = Grown(given_.box, reach_, true);
  const auto each = [&](std::int64_t parity, auto&& visit) {
    for (std::int64_t y = box.y + ((box.y ^ parity) & 1); y < box.y + box.rows;
         y += 2) {
      for (std::int64_t x = box.x + ((box.x ^ parity) & 1);
           x < box.x + box.columns; x += 2) {
        const double weight = work_.values[IndexOf(x, y)];
        if (std::fabs(weight) >= kLeastWeight) {
          visit(LatticePoint{x, y}, weight);
        }
      }
    }
  };
  if (source_ == FractalSource::kSuccessive) {
    // Corners move after the centres were computed from where they stood.
    each(0, [&](LatticePoint point, double weight) {
      ancestors->push_back({HalfStep::kCentre, point, weight});
    });
  }
  each(1, [&](LatticePoint point, double weight) {
    ancestors->push_back({HalfStep::kCentre, point, weight});
    PushCentre(point.x, point.y, weight);
  });
}

void AncestorWalk::Line(std::vector<Ancestor>* ancestors) {
  const LatticeBox& box = given_.box;
  for (std::int64_t x = box.x; x < box.x + box.columns; ++x) {
    const double weight = given_.values[static_cast<std::size_t>(x - box.x)];
    if (weight == 0) continue;
    if (Odd(x) || source_ == FractalSource::kSuccessive) {
      ancestors->push_back({HalfStep::kEdge, {x, 0}, weight});
    }
    if (!Odd(x)) continue;
    for (std::size_t a = 0; a < 4; ++a) {
      if (source_ == FractalSource::kSubdivision) {
        Add(x + kPlaces[a], 0, weight * kWeights[a]);
      } else if (a == 1 || a == 2) {
        Add(x + kPlaces[a], 0, weight * 0.5);
      }
    }
  }
}

}  // namespace terrane::core
