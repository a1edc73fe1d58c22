#include "core/terrain/deviation_model.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/det_math.h"

namespace terrane::core {
namespace {

// Entries of a table of deviations by H: linear in between is off by less than
// 2e-5 of the deviation at level 30.
constexpr int kTableSize = 1025;

// AREA samples of the finest level are points of the next one.
constexpr int kLevels = kMaxLevel + 2;

std::size_t SlotOf(int level, HalfStep step) {
  return static_cast<std::size_t>(2 * level +
                                  (step == HalfStep::kEdge ? 1 : 0));
}

// The points of `axis` that lie inside the domain, and where each point of the
// axis finds its mirror image among them.
struct MirroredAxis {
  EverySecond inside;
  bool identity = true;
  std::vector<int> image;
};

MirroredAxis MirrorAxis(const EverySecond& axis,
                        const std::function<std::int64_t(std::int64_t)>& of) {
  MirroredAxis result;
  const std::int64_t end = axis.first + 2 * (axis.count - 1);
  if (of(axis.first) == axis.first && of(end) == end) {
    result.inside = axis;
    return result;
  }
  result.identity = false;
  std::vector<std::int64_t> images;
  for (int i = 0; i < axis.count; ++i) images.push_back(of(axis.first + 2 * i));
  const auto [low, high] = std::minmax_element(images.begin(), images.end());
  result.inside = {*low, static_cast<int>((*high - *low) / 2) + 1};
  for (const std::int64_t image : images) {
    result.image.push_back(static_cast<int>((image - *low) / 2));
  }
  return result;
}

}  // namespace

DeviationModel::DeviationModel(Config config)
    : config_(std::move(config)),
      level0_(static_cast<float>(Level0Deviation(config_.source))) {
  uniform_.resize(2 * kLevels);
  const ConstraintField* field = config_.roughness_field.get();
  if (field != nullptr && !field->empty()) {
    MakeTables(field->minimum(), field->maximum());
  }
  for (int level = 1; level < kLevels; ++level) {
    for (const HalfStep step : {HalfStep::kCentre, HalfStep::kEdge}) {
      const std::size_t slot = SlotOf(level, step);
      // A point beyond every source must get the same bits whether or not a
      // source reaches another point of its window: so from the table, too.
      uniform_[slot] = tables_.empty()
                           ? static_cast<float>(DisplacementDeviation(
                                 config_.source, config_.dimensions,
                                 config_.roughness, level, step))
                           : LookUp(tables_[slot], field->background());
    }
  }
}

void DeviationModel::MakeTables(float minimum, float maximum) {
  const double span = static_cast<double>(maximum) - minimum;
  table_minimum_ = minimum;
  table_scale_ = span > 0 ? static_cast<float>((kTableSize - 1) / span) : 0;
  tables_.assign(2 * kLevels, Table(kTableSize));
  for (int k = 0; k < kTableSize; ++k) {
    const double roughness = minimum + span * k / (kTableSize - 1);
    // Every level's deviation is level 1's times a power of 2^-H.
    const double ratio = DetExp2(-roughness);
    for (const HalfStep step : {HalfStep::kCentre, HalfStep::kEdge}) {
      double value = DisplacementDeviation(config_.source, config_.dimensions,
                                           roughness, 1, step);
      for (int level = 1; level < kLevels; ++level, value *= ratio) {
        tables_[SlotOf(level, step)][static_cast<std::size_t>(k)] =
            static_cast<float>(value);
      }
    }
  }
}

float DeviationModel::LookUp(const Table& table, float roughness) const {
  const float at = (roughness - table_minimum_) * table_scale_;
  const float whole = std::clamp(at, 0.0f, static_cast<float>(kTableSize - 2));
  const auto k = static_cast<std::size_t>(whole);
  const float t = at - static_cast<float>(k);
  return table[k] + t * (table[k + 1] - table[k]);
}

void DeviationModel::FillPlane(int level, HalfStep step, const SampleGrid& grid,
                               GridView plane, bool by_roughness,
                               const GridView& roughness) const {
  const auto rows = static_cast<std::ptrdiff_t>(grid.v.size());
  const auto columns = static_cast<std::ptrdiff_t>(grid.u.size());
  if (config_.amplitude) {
    config_.amplitude->Sample(grid.u, grid.v, plane.data, plane.stride);
  }
  const std::size_t slot = SlotOf(level, step);
  for (std::ptrdiff_t j = 0; j < rows; ++j) {
    float* row = plane.Row(j);
    if (!config_.amplitude) std::fill_n(row, columns, 1.0f);
    if (!by_roughness) {
      for (std::ptrdiff_t i = 0; i < columns; ++i) row[i] *= uniform_[slot];
      continue;
    }
    const float* h = roughness.Row(j);
    for (std::ptrdiff_t i = 0; i < columns; ++i) {
      row[i] *= LookUp(tables_[slot], h[i]);
    }
  }
}

Deviation DeviationModel::At(int level, HalfStep step, EverySecond columns,
                             EverySecond rows, GridBuffer* buffer,
                             Scratch* scratch) const {
  const Deviation uniform = {uniform_[SlotOf(level, step)], {}};
  const bool has_field =
      config_.roughness_field != nullptr && !config_.roughness_field->empty();
  if (!has_field && !config_.amplitude) return uniform;

  const MirroredAxis x = MirrorAxis(columns, [&](std::int64_t index) {
    return config_.mirror.X(index, level);
  });
  const MirroredAxis y = MirrorAxis(rows, [&](std::int64_t index) {
    return config_.dimensions == 1 ? index : config_.mirror.Y(index, level);
  });
  FillSampleGrid(config_.frame, level, x.inside.first, y.inside.first, 2,
                 x.inside.count, y.inside.count, &scratch->grid);
  bool by_roughness = false;
  GridView roughness;
  if (has_field) {
    roughness = scratch->roughness.Shape(x.inside.count, y.inside.count);
    by_roughness = config_.roughness_field->Evaluate(
        scratch->grid, roughness.data, roughness.stride, scratch->stop);
  }
  if (!by_roughness && !config_.amplitude) return uniform;

  const GridView plane = buffer->Shape(columns.count, rows.count);
  if (x.identity && y.identity) {
    FillPlane(level, step, scratch->grid, plane, by_roughness, roughness);
    return {0, plane};
  }
  const GridView inside = scratch->inside.Shape(x.inside.count, y.inside.count);
  FillPlane(level, step, scratch->grid, inside, by_roughness, roughness);
  for (int j = 0; j < rows.count; ++j) {
    const float* from =
        inside.Row(y.identity ? j : y.image[static_cast<std::size_t>(j)]);
    float* to = plane.Row(j);
    for (int i = 0; i < columns.count; ++i) {
      to[i] = from[x.identity ? i : x.image[static_cast<std::size_t>(i)]];
    }
  }
  return {0, plane};
}

}  // namespace terrane::core
