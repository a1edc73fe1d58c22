#include "core/terrain/constraint_field.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/grid/box_index.h"
#include "core/grid/line_distance.h"
#include "core/grid/sample_rect.h"

namespace terrane::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

// What finding the sources of one sample costs, in units of finding the samples
// of one source: with more sources than this times the samples in a grid's box,
// as in a coarse grid over wide ground, samples look for their sources.
constexpr std::size_t kSourcesPerSample = 2;

// A source, ready to be evaluated.
class Source {
 public:
  Source(const ContinuousConstraint& constraint, double background,
         int dimensions)
      : distance_(MakeDistance(constraint, dimensions)),
        difference_(constraint.target - background),
        falloff_(constraint.falloff),
        reach_(constraint.reach),
        is_smooth_(constraint.edge == ReachEdge::kSmooth) {}

  // Holds the source's domain, eq. 13.
  Box ReachBox() const { return distance_.box().Grown(reach_); }

  // Squared distances of the samples, infinity beyond the reach.
  void SquaredDistances(const SampleGrid& grid, const SampleRect& rect,
                        double* out) const {
    distance_.Squared(grid, rect, reach_, out);
  }

  // The term of eq. 15 before it is divided by M, at a distance within the
  // reach.
  double Pull(double squared_distance) const {
    const double pull = difference_ / (1.0 + falloff_ * squared_distance);
    if (!is_smooth_) return pull;
    const double window = 1.0 - squared_distance / (reach_ * reach_);
    return pull * (window * window);
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
  double difference_;
  double falloff_;
  double reach_;
  bool is_smooth_;
};

// Terms of the sources that reach one sample, added in the order of the
// sources.
struct Sum {
  double pulls = 0;
  double sources = 0;  // M of eq. 15

  void Add(double pull) {
    pulls += pull;
    sources += 1;
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

  bool Evaluate(const SampleGrid& grid, float* out,
                std::ptrdiff_t stride) const {
    const SampleRect all = AllSamples(grid);
    if (sources_.empty() || all.empty()) return false;
    const std::size_t samples = all.columns() * all.rows();
    std::vector<std::uint32_t> ids;
    const bool few =
        index_.Query(BoxOf(grid, all), kSourcesPerSample * samples, &ids);
    if (few && ids.empty()) return false;
    std::vector<Sum> sums(samples);
    const bool reached =
        few ? AddBySource(grid, ids, &sums) : AddBySample(grid, &sums);
    if (!reached) return false;
    for (std::size_t j = 0; j < all.rows(); ++j) {
      float* row = out + static_cast<std::ptrdiff_t>(j) * stride;
      for (std::size_t i = 0; i < all.columns(); ++i) {
        row[i] = Value(sums[j * all.columns() + i]);
      }
    }
    return true;
  }

 private:
  // Every source adds itself to the samples in its reach.
  bool AddBySource(const SampleGrid& grid,
                   const std::vector<std::uint32_t>& ids,
                   std::vector<Sum>* sums) const {
    bool reached = false;
    std::vector<double> distances;
    for (const std::uint32_t id : ids) {
      const Source& source = sources_[id];
      const SampleRect rect = SamplesIn(grid, source.ReachBox());
      if (rect.empty()) continue;
      distances.resize(rect.columns() * rect.rows());
      source.SquaredDistances(grid, rect, distances.data());
      const double* distance = distances.data();
      for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
        Sum* row = sums->data() + j * grid.x.size();
        for (std::size_t i = rect.column_begin; i < rect.column_end; ++i) {
          const double squared = *distance++;
          if (squared == kInfinity) continue;
          row[i].Add(source.Pull(squared));
          reached = true;
        }
      }
    }
    return reached;
  }

  // Every sample looks for the sources whose reach may hold it.
  bool AddBySample(const SampleGrid& grid, std::vector<Sum>* sums) const {
    bool reached = false;
    std::vector<std::uint32_t> ids;
    for (std::size_t j = 0; j < grid.y.size(); ++j) {
      for (std::size_t i = 0; i < grid.x.size(); ++i) {
        const SampleRect here{i, i + 1, j, j + 1};
        index_.Query(BoxOf(grid, here), kAny, &ids);
        for (const std::uint32_t id : ids) {
          double squared = 0;
          sources_[id].SquaredDistances(grid, here, &squared);
          if (squared == kInfinity) continue;
          (*sums)[j * grid.x.size() + i].Add(sources_[id].Pull(squared));
          reached = true;
        }
      }
    }
    return reached;
  }

  // Eq. 15.
  float Value(const Sum& sum) const {
    if (sum.sources == 0) return static_cast<float>(background_);
    // Rounding must not leave the range that minimum() and maximum() promise.
    return static_cast<float>(
        std::clamp(background_ + sum.pulls / sum.sources, minimum_, maximum_));
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
                               std::ptrdiff_t stride) const {
  return impl_->Evaluate(grid, out, stride);
}

}  // namespace terrane::core
