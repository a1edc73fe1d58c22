#include "core/surface/surface_rows.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/noise/counter_hash.h"
#include "core/surface/adaline.h"

namespace terrane::core {
namespace {

std::size_t Padded(std::int64_t count) {
  return static_cast<std::size_t>(count + kRowSlack);
}

float DrawFactor(double random) {
  return static_cast<float>(random * kDrawUnit);
}

DesiredResponse DesiredOf(const WeightTable& table, std::int64_t iu) {
  return {static_cast<float>(table.desired()),
          DrawFactor(table.desired_random()), table.DesiredKey(iu)};
}

}  // namespace

SurfaceRows::SurfaceRows(const SurfaceModel* model, const SurfaceGrid& grid,
                         std::int64_t first, std::int64_t count)
    : model_(*model),
      grid_(grid),
      first_(first),
      count_(count),
      carried_(model) {
  PrepareColumns();
}

void SurfaceRows::PrepareColumns() {
  const Basis& basis = model_.along_t;
  // Pairs begin at even inputs, which may be one before the support.
  const int most_inputs = (basis.support() + 2) / 2 * 2;
  inputs_ = inputs_buffer_.Shape(count_, most_inputs);
  std::fill_n(inputs_.data, inputs_.stride * most_inputs, 0.0f);
  words_.assign(Padded(count_), 0);
  norms_.assign(Padded(count_), 1.0);
  std::array<double, Basis::kMaxCount> values;
  for (std::int64_t c = 0; c < count_; ++c) {
    const auto column = static_cast<std::size_t>(c);
    const int first =
        basis.Values(GridParameter(first_ + c, grid_.columns), values);
    const int first_pair = first / 2;
    double norm = 0;
    for (int k = 0; k < basis.support(); ++k) {
      const double value = values[static_cast<std::size_t>(k)];
      norm += value * value;
      inputs_.At(c, first + k - 2 * first_pair) = static_cast<float>(value);
    }
    norms_[column] = norm;
    words_[column] = ColumnWord(first_ + c);
    const int pairs = (first + basis.support() + 1) / 2 - first_pair;
    if (spans_.empty() || spans_.back().first_pair != first_pair ||
        spans_.back().pairs != pairs) {
      spans_.push_back({c, 0, first_pair, pairs});
    }
    ++spans_.back().count;
  }
  column_gains_.assign(Padded(count_), 0.0f);
  TrainingGains(model_.spec.training, norms_, &work_, column_gains_);
  gains_ = column_gains_;
}

void SurfaceRows::SetRow(std::int64_t iu) {
  iu_ = iu;
  first_u_ = model_.along_u.Values(GridParameter(iu, grid_.rows), values_u_);
  norm_u_ = 0;
  for (int l = 0; l < model_.along_u.support(); ++l) {
    norm_u_ += BlendU(l) * BlendU(l);
  }
  FoldNet();
}

void SurfaceRows::FoldNetworks() {
  along_t_.drawn.clear();
  along_t_.desired = DesiredOf(model_.network, iu_);
  if (model_.spec.method == SurfaceMethod::kProducts) {
    FoldProducts();
  } else {
    FoldAlongT();
  }
  if (HasNetworkU(model_.spec.method)) FoldAlongU();
  SetGains();
}

// The net blended along u: what is left is a curve along t.
void SurfaceRows::FoldNet() {
  const int columns = model_.spec.net.columns;
  const auto padded = static_cast<std::size_t>(2 * ((columns + 1) / 2));
  for (std::vector<float>* column :
       {&regular_heights_, &flat_x_, &flat_y_, &flat_z_}) {
    column->assign(padded, 0.0f);
  }
  for (int i = 0; i < columns; ++i) {
    double height = 0;
    Point3 flat;
    for (int l = 0; l < model_.along_u.support(); ++l) {
      const double value = BlendU(l);
      const Point3& point = model_.Flat(i, first_u_ + l);
      height += value * model_.Height(i, first_u_ + l);
      flat.x += value * point.x;
      flat.y += value * point.y;
      flat.z += value * point.z;
    }
    const auto at = static_cast<std::size_t>(i);
    regular_heights_[at] = static_cast<float>(height);
    flat_x_[at] = static_cast<float>(flat.x);
    flat_y_[at] = static_cast<float>(flat.y);
    flat_z_[at] = static_cast<float>(flat.z);
  }
}

// Method 1: the inputs f_i f_j of one i, summed over j.
void SurfaceRows::FoldProducts() {
  const WeightTable& table = model_.network;
  const int columns = model_.spec.net.columns;
  along_t_.pairs.clear();
  for (int p = 0; p < table.pairs(); ++p) {
    InputPair pair = {};
    pair.drawn_begin = static_cast<int>(along_t_.drawn.size());
    double weight[2] = {}, readout[2] = {}, squared[2] = {};
    for (int l = 0; l < model_.along_u.support(); ++l) {
      const int j = first_u_ + l;
      const double f = BlendU(l);
      DrawnPair draw = {table.PairKey(p, j, iu_), {}, {}};
      for (int k = 0; k < 2 && 2 * p + k < columns; ++k) {
        const InitialWeight& initial = table.At(2 * p + k, j);
        const double height = model_.Height(2 * p + k, j);
        weight[k] += f * initial.base;
        readout[k] += f * initial.base * height;
        squared[k] += f * f * height;
        draw.weight[k] = DrawFactor(f * initial.random);
        draw.readout[k] = DrawFactor(f * initial.random * height);
      }
      if (draw.weight[0] != 0 || draw.weight[1] != 0) {
        along_t_.drawn.push_back(draw);
      }
    }
    for (int k = 0; k < 2; ++k) {
      pair.weight[k] = static_cast<float>(weight[k]);
      pair.readout[k] = static_cast<float>(readout[k]);
      pair.squared[k] = static_cast<float>(squared[k]);
    }
    pair.drawn_end = static_cast<int>(along_t_.drawn.size());
    along_t_.pairs.push_back(pair);
  }
}

// Methods 2 to 4: the inputs f_i, read out over the heights blended along u.
void SurfaceRows::FoldAlongT() {
  const WeightTable& table = model_.network;
  along_t_.pairs.clear();
  for (int p = 0; p < table.pairs(); ++p) {
    InputPair pair = {};
    pair.drawn_begin = static_cast<int>(along_t_.drawn.size());
    DrawnPair draw = {table.PairKey(p, 0, iu_), {}, {}};
    for (int k = 0; k < 2; ++k) {
      const InitialWeight& initial = table.At(2 * p + k, 0);
      const float height =
          regular_heights_[static_cast<std::size_t>(2 * p + k)];
      pair.weight[k] = static_cast<float>(initial.base);
      pair.readout[k] = static_cast<float>(initial.base * height);
      pair.squared[k] = height;
      draw.weight[k] = DrawFactor(initial.random);
      draw.readout[k] = DrawFactor(initial.random * height);
    }
    if (draw.weight[0] != 0 || draw.weight[1] != 0) {
      along_t_.drawn.push_back(draw);
    }
    pair.drawn_end = static_cast<int>(along_t_.drawn.size());
    along_t_.pairs.push_back(pair);
  }
}

// The second network's inputs f_j, and the heights it is read out over.
void SurfaceRows::FoldAlongU() {
  const WeightTable& table = model_.network_u;
  const int support = model_.along_u.support();
  const int first_pair = first_u_ / 2;
  const int columns = model_.spec.net.columns;
  pairs_u_ = (first_u_ + support + 1) / 2 - first_pair;
  along_u_.pairs.clear();
  along_u_.drawn.clear();
  along_u_.desired = DesiredOf(table, iu_);
  block_stride_ = 2 * pairs_u_;
  block_heights_.assign(
      static_cast<std::size_t>(2 * ((columns + 1) / 2) * block_stride_), 0.0f);
  for (int p = first_pair; p < first_pair + pairs_u_; ++p) {
    InputPair pair = {};
    pair.drawn_begin = static_cast<int>(along_u_.drawn.size());
    DrawnPair draw = {table.PairKey(p, 0, iu_), {}, {}};
    for (int k = 0; k < 2; ++k) {
      const int j = 2 * p + k;
      if (j < first_u_ || j >= first_u_ + support) continue;
      const double f = BlendU(j - first_u_);
      const InitialWeight& initial = table.At(j, 0);
      pair.weight[k] = static_cast<float>(f * initial.base);
      pair.squared[k] = static_cast<float>(f * f);
      draw.weight[k] = DrawFactor(f * initial.random);
      for (int i = 0; i < columns; ++i) {
        block_heights_[static_cast<std::size_t>(i * block_stride_ + j -
                                                2 * first_pair)] =
            static_cast<float>(model_.Height(i, j));
      }
    }
    if (draw.weight[0] != 0 || draw.weight[1] != 0) {
      along_u_.drawn.push_back(draw);
    }
    pair.drawn_end = static_cast<int>(along_u_.drawn.size());
    along_u_.pairs.push_back(pair);
  }
}

void SurfaceRows::SetGains() {
  // The other methods' inputs along t are the same in every row.
  if (model_.spec.method != SurfaceMethod::kProducts) return;
  if (!model_.spec.training.has_value()) {
    // 1 / |x|^2 is a product of the two axes'.
    const auto row_gain = static_cast<float>(1.0 / norm_u_);
    for (std::size_t c = 0; c < gains_.size(); ++c) {
      gains_[c] = column_gains_[c] * row_gain;
    }
    return;
  }
  row_norms_.resize(norms_.size());
  for (std::size_t c = 0; c < norms_.size(); ++c) {
    row_norms_[c] = norms_[c] * norm_u_;
  }
  TrainingGains(model_.spec.training, row_norms_, &work_, gains_);
}

ColumnRun SurfaceRows::RunOf(const Span& span) const {
  return {inputs_.data + span.begin,
          inputs_.stride,
          span.pairs,
          words_.data() + span.begin,
          gains_.data() + span.begin,
          static_cast<int>(span.count)};
}

bool SurfaceRows::Heights(const std::stop_token& stop, float* out) {
  if (model_.spec.carry_over) {
    return carried_.Heights(grid_, iu_, first_, count_, stop, out);
  }
  FoldNetworks();
  for (const Span& span : spans_) {
    const ColumnRun run = RunOf(span);
    const OneNetworkRow along_t = along_t_.From(span.first_pair);
    float* const place = out + span.begin;
    if (!HasNetworkU(model_.spec.method)) {
      OneNetworkHeights(run, along_t, place);
      continue;
    }
    TwoNetworksRow row;
    row.along_t = along_t;
    row.along_u = along_u_.From(0);
    row.pairs_u = pairs_u_;
    row.gain_u =
        static_cast<float>(TrainingGain(model_.spec.training, norm_u_));
    row.heights = block_heights_.data() + 2 * span.first_pair * block_stride_;
    row.heights_stride = block_stride_;
    if (model_.spec.method == SurfaceMethod::kTwoFactors) {
      TwoFactorsHeights(run, row, place);
    } else {
      TwoTermsHeights(run, row, place);
    }
  }
  return !stop.stop_requested();
}

void SurfaceRows::RegularHeights(float* out) const {
  for (const Span& span : spans_) {
    BlendControls(RunOf(span), regular_heights_.data() + 2 * span.first_pair,
                  out + span.begin);
  }
}

void SurfaceRows::Positions(const float* heights, float* x, float* y,
                            float* z) const {
  const Point3& direction = model_.direction;
  for (const Span& span : spans_) {
    const std::ptrdiff_t first = 2 * span.first_pair;
    const PositionRow row = {
        flat_x_.data() + first,          flat_y_.data() + first,
        flat_z_.data() + first,          static_cast<float>(direction.x),
        static_cast<float>(direction.y), static_cast<float>(direction.z)};
    BlendPositions(RunOf(span), row, heights + span.begin, x + span.begin,
                   y + span.begin, z + span.begin);
  }
}

}  // namespace terrane::core
