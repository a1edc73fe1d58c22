// Rows of a surface whose networks carry their weights over along t.
//
// The network at (t+1, u) starts from the trained weights at (t, u); weights
// whose rule says so are set anew by it. The first sample of a row starts from
// the rules. So a row is a recurrence: a window that begins at column x costs
// x more samples in each of its rows. In double precision and one by one: ten
// to fifteen times the cost of independent samples.
//
// Threads: a CarriedRow belongs to one thread. Determinism: a height is a
// function of (spec, grid, it, iu).
#ifndef TERRANE_CORE_SURFACE_CARRY_OVER_H_
#define TERRANE_CORE_SURFACE_CARRY_OVER_H_

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "core/surface/surface_model.h"

namespace terrane::core {

class CarriedRow {
 public:
  explicit CarriedRow(const SurfaceModel* model) : model_(*model) {}

  // Writes the perturbed coordinates of columns [first, first + count) of row
  // iu; false when stopped.
  bool Heights(const SurfaceGrid& grid, std::int64_t iu, std::int64_t first,
               std::int64_t count, const std::stop_token& stop, float* out);

 private:
  // The blending functions at a parameter that may differ from 0.
  struct Blend {
    int first = 0;
    int count = 0;
    double squared_norm = 0;
    std::array<double, Basis::kMaxCount> values;
  };
  // The weights of one network: of input (i, j) at j * columns + i.
  struct Weights {
    int columns = 0;
    std::vector<double> values;

    double& At(int i, int j) {
      return values[static_cast<std::size_t>(j * columns + i)];
    }
  };

  static void Evaluate(const Basis& basis, double parameter, Blend* blend);
  // Sets what does not carry over, then trains at the inputs f_i f_j.
  void Train(const WeightTable& table, const Blend& along_i,
             const Blend& along_j, std::int64_t it, std::int64_t iu,
             Weights* weights) const;
  void Start(const WeightTable& table, int columns, int rows, std::int64_t iu,
             Weights* weights) const;
  double Height(const Blend& blend_t, const Blend& blend_u);

  const SurfaceModel& model_;
  Weights weights_;
  Weights weights_u_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SURFACE_CARRY_OVER_H_
