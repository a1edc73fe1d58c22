#include "core/terrain/constraint_field.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/grid/box_index.h"
#include "core/grid/line_distance.h"
#include "core/grid/sample_rect.h"
#include "core/terrain/constraint_kernels.h"

namespace terrane::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

// What finding the sources of one sample costs, in units of finding the samples
// of one source: with more sources than this times the samples in a grid's box,
// as in a coarse grid over wide ground, samples look for their sources.
constexpr std::size_t kSourcesPerSample = 4;

// Samples that are evaluated together: their sums stay in the cache.
constexpr std::size_t kBandSamples = 16384;

// A source, ready to be evaluated.
class Source {
 public:
  Source(const ContinuousConstraint& constraint, double background,
         int dimensions)
      : distance_(MakeDistance(constraint, dimensions)),
        reach_(constraint.reach),
        term_{constraint.target - background, constraint.falloff,
              constraint.reach * constraint.reach,
              constraint.edge == ReachEdge::kSmooth} {}

  // Holds the source's domain, eq. 13.
  Box ReachBox() const { return distance_.box().Grown(reach_); }

  // Squared distances of the samples, infinity beyond the reach.
  void SquaredDistances(const SampleGrid& grid, const SampleRect& rect,
                        double* out) const {
    distance_.Squared(grid, rect, reach_, out);
  }

  // Adds the term of eq. 15 before it is divided by M, and the source's share
  // of M, to each sample of a row that is within reach. A smooth source counts
  // as it fades: if it counted as 1 from its border on, the pull of every other
  // source would halve there at once.
  void AddTo(std::span<const double> squared_distances, double* pulls,
             double* counts) const {
    AddSourceTerms(term_, squared_distances.data(), squared_distances.size(),
                   pulls, counts);
  }

 private:
  static LineDistance MakeDistance(const ContinuousConstraint& constraint,
                                   int dimensions) {
    std::vector<LineDistance::Vertex> vertices;
    vertices.reserve(constraint.vertices.size());
    for (const Point2& point : constraint.vertices) {
      vertices.push_back({point.x, point.y});
    }
    return LineDistance(
        vertices,
        constraint.kind == SourceKind::kPolygon ? LineDistance::Form::kPolygon
                                                : LineDistance::Form::kPolyline,
        constraint.norm == DistanceNorm::kL1 ? LineDistance::Norm::kL1
                                             : LineDistance::Norm::kL2,
        dimensions);
  }

  LineDistance distance_;
  double reach_;
  SourceTerm term_;
};

// A band of samples being summed; the memory is reused from band to band.
struct Band {
  SampleRect rect;
  // Terms of eq. 15 before they are divided by M, added in the order of the
  // sources, and M itself.
  std::vector<double> pulls;
  std::vector<double> counts;
  // Working memory.
  std::vector<std::uint32_t> ids;
  std::vector<double> distances;

  void Reset(const SampleRect& samples) {
    rect = samples;
    pulls.assign(rect.columns() * rect.rows(), 0.0);
    counts.assign(rect.columns() * rect.rows(), 0.0);
  }

  // Adds a source to the samples of `part`.
  void Add(const Source& source, const SampleGrid& grid,
           const SampleRect& part) {
    distances.resize(part.columns() * part.rows());
    source.SquaredDistances(grid, part, distances.data());
    for (std::size_t j = 0; j < part.rows(); ++j) {
      const std::size_t first =
          (part.row_begin + j - rect.row_begin) * rect.columns() +
          part.column_begin - rect.column_begin;
      source.AddTo(
          std::span(distances).subspan(j * part.columns(), part.columns()),
          pulls.data() + first, counts.data() + first);
    }
  }

  bool reached() const {
    return std::any_of(counts.begin(), counts.end(),
                       [](double count) { return count > 0; });
  }
};

std::vector<Source> MakeSources(
    std::span<const ContinuousConstraint> constraints,
    ConstraintQuantity quantity, double background, int dimensions) {
  std::vector<Source> sources;
  for (const ContinuousConstraint& constraint : constraints) {
    if (constraint.quantity == quantity) {
      sources.emplace_back(constraint, background, dimensions);
    }
  }
  return sources;
}

BoxIndex MakeIndex(std::span<const Source> sources) {
  std::vector<Box> boxes;
  boxes.reserve(sources.size());
  for (const Source& source : sources) boxes.push_back(source.ReachBox());
  return BoxIndex(boxes);
}

}  // namespace

class ConstraintField::Impl {
 public:
  Impl(std::span<const ContinuousConstraint> constraints,
       ConstraintQuantity quantity, double background, int dimensions)
      : background_(background),
        minimum_(background),
        maximum_(background),
        sources_(MakeSources(constraints, quantity, background, dimensions)),
        index_(MakeIndex(sources_)) {
    // A mean of terms between 0 and target - F0 stays between F0 and a target.
    for (const ContinuousConstraint& constraint : constraints) {
      if (constraint.quantity != quantity) continue;
      minimum_ = std::min(minimum_, constraint.target);
      maximum_ = std::max(maximum_, constraint.target);
    }
  }

  bool empty() const { return sources_.empty(); }
  double background() const { return background_; }
  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }

  bool Evaluate(const SampleGrid& grid, float* out, std::ptrdiff_t stride,
                const std::stop_token& stop) const {
    const SampleRect all = AllSamples(grid);
    if (sources_.empty() || all.empty()) return false;
    const std::size_t band_rows =
        std::clamp<std::size_t>(kBandSamples / all.columns(), 1, all.rows());
    const auto fill = [&](std::size_t first_row, std::size_t last_row) {
      for (std::size_t j = first_row; j < last_row; ++j) {
        std::fill_n(out + static_cast<std::ptrdiff_t>(j) * stride,
                    all.columns(), static_cast<float>(background_));
      }
    };
    Band band;
    bool reached = false;
    for (std::size_t row = 0; row < all.rows(); row += band_rows) {
      SampleRect rect = all;
      rect.row_begin = row;
      rect.row_end = std::min(row + band_rows, all.rows());
      if (SumBand(grid, rect, stop, &band)) {
        // Nothing is written before it is known that something reaches.
        if (!reached) fill(0, row);
        reached = true;
        WriteBand(band, out, stride);
      } else if (reached) {
        fill(row, rect.row_end);
      }
    }
    return reached;
  }

 private:
  // Sums the sources over the samples of `rect`; false when none reaches them.
  bool SumBand(const SampleGrid& grid, const SampleRect& rect,
               const std::stop_token& stop, Band* band) const {
    const std::size_t samples = rect.columns() * rect.rows();
    if (!index_.Query(BoxOf(grid, rect), kSourcesPerSample * samples,
                      &band->ids)) {
      band->Reset(rect);
      AddBySample(grid, stop, band);
    } else if (!band->ids.empty()) {
      band->Reset(rect);
      AddBySource(grid, stop, band);
    } else {
      return false;
    }
    return band->reached();
  }

  // Every source adds itself to the samples in its reach.
  void AddBySource(const SampleGrid& grid, const std::stop_token& stop,
                   Band* band) const {
    for (const std::uint32_t id : band->ids) {
      if (stop.stop_requested()) return;
      const Source& source = sources_[id];
      const SampleRect part =
          Intersection(SamplesIn(grid, source.ReachBox()), band->rect);
      if (!part.empty()) band->Add(source, grid, part);
    }
  }

  // Every sample looks for the sources whose reach may hold it.
  void AddBySample(const SampleGrid& grid, const std::stop_token& stop,
                   Band* band) const {
    const SampleRect& rect = band->rect;
    for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
      if (stop.stop_requested()) return;
      for (std::size_t i = rect.column_begin; i < rect.column_end; ++i) {
        const SampleRect here{i, i + 1, j, j + 1};
        index_.Query(BoxOf(grid, here), kAny, &band->ids);
        for (const std::uint32_t id : band->ids) {
          band->Add(sources_[id], grid, here);
        }
      }
    }
  }

  // Eq. 15. Rounding must not leave the range that minimum() and maximum()
  // promise; out of every reach the sum is 0.
  void WriteBand(const Band& band, float* out, std::ptrdiff_t stride) const {
    const std::size_t columns = band.rect.columns();
    for (std::size_t j = 0; j < band.rect.rows(); ++j) {
      const double* pulls = band.pulls.data() + j * columns;
      const double* counts = band.counts.data() + j * columns;
      float* row =
          out + static_cast<std::ptrdiff_t>(band.rect.row_begin + j) * stride;
      for (std::size_t i = 0; i < columns; ++i) {
        const double value = background_ + pulls[i] / std::max(counts[i], 1.0);
        row[i] =
            static_cast<float>(std::min(std::max(value, minimum_), maximum_));
      }
    }
  }

  double background_;
  double minimum_;
  double maximum_;
  std::vector<Source> sources_;
  BoxIndex index_;
};

ConstraintField::ConstraintField(
    std::span<const ContinuousConstraint> constraints,
    ConstraintQuantity quantity, double background, int dimensions)
    : impl_(std::make_unique<Impl>(constraints, quantity, background,
                                   dimensions)) {}
ConstraintField::~ConstraintField() = default;
ConstraintField::ConstraintField(ConstraintField&&) noexcept = default;
ConstraintField& ConstraintField::operator=(ConstraintField&&) noexcept =
    default;

bool ConstraintField::empty() const { return impl_->empty(); }

float ConstraintField::background() const {
  return static_cast<float>(impl_->background());
}

float ConstraintField::minimum() const {
  return static_cast<float>(impl_->minimum());
}

float ConstraintField::maximum() const {
  return static_cast<float>(impl_->maximum());
}

bool ConstraintField::Evaluate(const SampleGrid& grid, float* out,
                               std::ptrdiff_t stride,
                               const std::stop_token& stop) const {
  return impl_->Evaluate(grid, out, stride, stop);
}

}  // namespace terrane::core
