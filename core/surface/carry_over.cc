#include "core/surface/carry_over.h"

#include <cstddef>

#include "core/surface/adaline.h"

namespace terrane::core {
namespace {

// Samples between two looks at the stop token: well under a millisecond for the
// largest net.
constexpr std::int64_t kSamplesPerPoll = 64;

}  // namespace

void CarriedRow::Evaluate(const Basis& basis, double parameter, Blend* blend) {
  blend->first = basis.Values(parameter, blend->values);
  blend->count = basis.support();
  blend->squared_norm = 0;
  for (int k = 0; k < blend->count; ++k) {
    const double value = blend->values[static_cast<std::size_t>(k)];
    blend->squared_norm += value * value;
  }
}

void CarriedRow::Start(const WeightTable& table, int columns, int rows,
                       std::int64_t iu, Weights* weights) const {
  weights->columns = columns;
  weights->values.resize(static_cast<std::size_t>(columns * rows));
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      weights->At(i, j) = table.Initial(i, j, 0, iu);
    }
  }
}

void CarriedRow::Train(const WeightTable& table, const Blend& along_i,
                       const Blend& along_j, std::int64_t it, std::int64_t iu,
                       Weights* weights) const {
  const auto input = [&](int k, int l) {
    return along_i.values[static_cast<std::size_t>(k)] *
           along_j.values[static_cast<std::size_t>(l)];
  };
  double sum = 0;
  for (int l = 0; l < along_j.count; ++l) {
    for (int k = 0; k < along_i.count; ++k) {
      const int i = along_i.first + k;
      const int j = along_j.first + l;
      double& weight = weights->At(i, j);
      if (table.At(i, j).redraw) weight = table.Initial(i, j, it, iu);
      sum += input(k, l) * weight;
    }
  }
  const double step = (table.Desired(it, iu) - sum) *
                      TrainingGain(model_.spec.training,
                                   along_i.squared_norm * along_j.squared_norm);
  for (int l = 0; l < along_j.count; ++l) {
    for (int k = 0; k < along_i.count; ++k) {
      weights->At(along_i.first + k, along_j.first + l) += input(k, l) * step;
    }
  }
}

double CarriedRow::Height(const Blend& blend_t, const Blend& blend_u) {
  const SurfaceMethod method = model_.spec.method;
  double height = 0;
  for (int l = 0; l < blend_u.count; ++l) {
    for (int k = 0; k < blend_t.count; ++k) {
      const int i = blend_t.first + k;
      const int j = blend_u.first + l;
      double weight = 0;
      switch (method) {
        case SurfaceMethod::kProducts:
          weight = weights_.At(i, j);
          break;
        case SurfaceMethod::kAlongT:
          weight = weights_.At(i, 0);
          break;
        case SurfaceMethod::kTwoFactors:
          weight = weights_.At(i, 0) * weights_u_.At(j, 0);
          break;
        case SurfaceMethod::kTwoTerms:
          weight = weights_.At(i, 0) + weights_u_.At(j, 0);
          break;
      }
      height += blend_t.values[static_cast<std::size_t>(k)] *
                blend_u.values[static_cast<std::size_t>(l)] * weight *
                model_.Height(i, j);
    }
  }
  return height;
}

bool CarriedRow::Heights(const SurfaceGrid& grid, std::int64_t iu,
                         std::int64_t first, std::int64_t count,
                         const std::stop_token& stop, float* out) {
  const SurfaceSpec& spec = model_.spec;
  const bool products = spec.method == SurfaceMethod::kProducts;
  const Blend one = {0, 1, 1.0, {1.0}};
  Blend blend_t;
  Blend blend_u;
  Evaluate(model_.along_u, GridParameter(iu, grid.rows), &blend_u);
  Start(model_.network, spec.net.columns, products ? spec.net.rows : 1, iu,
        &weights_);
  Start(model_.network_u, spec.net.rows, 1, iu, &weights_u_);
  for (std::int64_t it = 0; it < first + count; ++it) {
    if (it % kSamplesPerPoll == 0 && stop.stop_requested()) return false;
    Evaluate(model_.along_t, GridParameter(it, grid.columns), &blend_t);
    Train(model_.network, blend_t, products ? blend_u : one, it, iu, &weights_);
    if (HasNetworkU(spec.method)) {
      Train(model_.network_u, blend_u, one, it, iu, &weights_u_);
    }
    if (it >= first) {
      *out++ = static_cast<float>(Height(blend_t, blend_u));
    }
  }
  return true;
}

}  // namespace terrane::core
