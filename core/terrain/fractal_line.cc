#include "core/terrain/fractal_line.h"

#include <utility>

#include "core/terrain/displacement_draw.h"

namespace terrane::core {
namespace {

// Corners on each side that four-point subdivision takes beyond a cell.
constexpr std::int64_t kMargin = 1;

float FourPoint(float a, float b, float c, float d) {
  return (b + c) * (9.0f / 16) - (a + d) * (1.0f / 16);
}

}  // namespace

FractalLine::FractalLine(Config config, DeviationModel model, Imposed imposed)
    : config_(std::move(config)),
      model_(std::move(model)),
      imposed_(std::move(imposed)) {}

FractalLine::Line FractalLine::ParentOf(const Line& child) const {
  const std::int64_t first = child.first >> 1;
  const std::int64_t cells = ((child.first + child.count + 1) >> 1) - first;
  return {first - kMargin, cells + 1 + 2 * kMargin};
}

std::vector<FractalLine::Line> FractalLine::Ancestors(int level,
                                                      const Line& line) const {
  std::vector<Line> lines = {line};
  for (int n = level; n > 0; --n) lines.push_back(ParentOf(lines.back()));
  return lines;
}

std::int64_t FractalLine::PointsComputed(int level, std::int64_t count) const {
  std::int64_t points = 0;
  for (const Line& line : Ancestors(level, {0, count})) points += line.count;
  return points;
}

float FractalLine::Normal(int level, std::int64_t index) const {
  return DisplacementDraw(config_.seed, LineStream(level),
                          config_.mirror.X(index, level), 0);
}

std::span<const float> FractalLine::Points(int level, std::int64_t first,
                                           std::int64_t count,
                                           const std::stop_token& stop,
                                           Scratch* scratch) const {
  const std::vector<Line> lines = Ancestors(level, {first, count});
  scratch->buffered.clear();
  scratch->model.stop = stop;
  Line line = lines.back();
  FillLevel0(line, &scratch->lines[0]);
  Correct(0, HalfStep::kEdge, line, &scratch->lines[0]);
  MeetConstraints(0, line, &scratch->lines[0], scratch);
  for (int n = 1; n <= level; ++n) {
    if (stop.stop_requested()) return {};
    std::vector<float>& values = scratch->lines[n % 2];
    Refine(n, line, scratch->lines[(n - 1) % 2], &values, scratch);
    // Whole cells are refined; what stands over the line that was asked for
    // would grow with every further level.
    const Line& needed = lines[static_cast<std::size_t>(level - n)];
    const std::int64_t first_refined = 2 * (line.first + kMargin);
    values.erase(values.begin(),
                 values.begin() + (needed.first - first_refined));
    values.resize(static_cast<std::size_t>(needed.count));
    line = needed;
    Correct(n, HalfStep::kEdge, line, &values);
    AddBuffers(line, &values, scratch);
    MeetConstraints(n, line, &values, scratch);
  }
  return scratch->lines[level % 2];
}

void FractalLine::FillLevel0(const Line& line,
                             std::vector<float>* values) const {
  values->clear();
  for (std::int64_t i = 0; i < line.count; ++i) {
    values->push_back(Normal(0, line.first + i) * model_.level0());
  }
}

void FractalLine::Refine(int level, const Line& parent,
                         const std::vector<float>& from, std::vector<float>* to,
                         Scratch* scratch) const {
  const bool wide = config_.source == FractalSource::kSubdivision;
  const bool displace_all = config_.source == FractalSource::kSuccessive;
  const auto count = static_cast<int>(parent.count);
  const auto deviation = [&](int parity) {
    return model_.At(level, HalfStep::kEdge, {2 * parent.first + parity, count},
                     {0, 1}, &scratch->deviation, &scratch->model);
  };
  const auto at = [](const Deviation& d, std::size_t i) {
    return d.varies() ? d.per_point.data[i] : d.uniform;
  };
  const auto cells = static_cast<std::size_t>(parent.count - 1 - 2 * kMargin);
  to->resize(2 * cells);
  const Deviation odd = deviation(1);
  for (std::size_t k = 0; k < cells; ++k) {
    const std::size_t i = k + kMargin;
    const float mean =
        wide ? FourPoint(from[i - 1], from[i], from[i + 1], from[i + 2])
             : (from[i] + from[i + 1]) * 0.5f;
    const std::int64_t index =
        2 * (parent.first + static_cast<std::int64_t>(i)) + 1;
    (*to)[2 * k] = from[i];
    (*to)[2 * k + 1] = mean + Normal(level, index) * at(odd, i);
  }
  if (!displace_all) return;
  const Deviation even = deviation(0);
  const std::vector<bool> held = HeldPoints(level - 1, parent, scratch);
  for (std::size_t k = 0; k < cells; ++k) {
    const std::size_t i = k + kMargin;
    if (held[i]) continue;
    const std::int64_t index =
        2 * (parent.first + static_cast<std::int64_t>(i));
    (*to)[2 * k] += Normal(level, index) * at(even, i);
  }
}

void FractalLine::Correct(int level, HalfStep step, const Line& line,
                          std::vector<float>* values) const {
  if (imposed_.corrections == nullptr) return;
  const auto count = static_cast<int>(line.count);
  imposed_.corrections->AddTo(HalfStepSlot(level, step), line.first, 0, 1,
                              count, 1, {values->data(), count});
}

// Source SUCCESSIVE displaces every point at every level, but for the spots:
// they stay where they are.
std::vector<bool> FractalLine::HeldPoints(int level, const Line& line,
                                          Scratch* scratch) const {
  std::vector<bool> held(static_cast<std::size_t>(line.count));
  if (imposed_.pins == nullptr) return held;
  imposed_.pins->Find(level, line.first, 0, 1, line.count, 1, &scratch->pins);
  for (const SpotPins::Found& pin : scratch->pins) {
    held[static_cast<std::size_t>(pin.i)] = true;
  }
  return held;
}

// Eq. 11 with M = 2: the points half way to both parents get -P(p*) / 2.
void FractalLine::AddBuffers(const Line& line, std::vector<float>* values,
                             Scratch* scratch) const {
  for (std::size_t k = 0; k < scratch->buffered.size(); ++k) {
    for (const std::int64_t side : {-1, 1}) {
      const std::int64_t i = 2 * scratch->buffered[k].x + side - line.first;
      if (i < 0 || i >= line.count) continue;
      (*values)[static_cast<std::size_t>(i)] +=
          scratch->buffered_values[k] * -0.5f;
    }
  }
}

void FractalLine::MeetConstraints(int level, const Line& line,
                                  std::vector<float>* values,
                                  Scratch* scratch) const {
  scratch->buffered.clear();
  scratch->buffered_values.clear();
  scratch->found.clear();
  if (imposed_.constraints == nullptr) return;
  imposed_.constraints->Find(level, {line.first, 0, line.count, 1},
                             &scratch->found);
  for (const LatticePoint& point : scratch->found) {
    float& value = (*values)[static_cast<std::size_t>(point.x - line.first)];
    if (level > 0) {
      scratch->buffered.push_back(point);
      scratch->buffered_values.push_back(value);
    }
    value = 0;
  }
}

}  // namespace terrane::core
