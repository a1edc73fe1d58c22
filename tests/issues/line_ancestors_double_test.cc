// A line's ancestors were kept a point wider than needed at every level, which
// doubled with each finer one: a short profile at level 30 took gigabytes.
#include <gtest/gtest.h>

#include "core/terrain/fractal_line.h"

namespace terrane::core {
namespace {

TEST(LineAncestorsDouble, AShortProfileStaysShortAtEveryLevel) {
  DeviationModel::Config model;
  model.dimensions = 1;
  const FractalLine line({1, FractalSource::kSubdivision, {}},
                         DeviationModel(model), {});
  for (const int level : {0, 1, 12, 24, kMaxLevel}) {
    FractalLine::Scratch scratch;
    EXPECT_EQ(line.Points(level, 1001, 50, {}, &scratch).size(), 50u);
    for (const std::vector<float>& values : scratch.lines) {
      EXPECT_LT(values.capacity(), 200u) << "level " << level;
    }
  }
}

}  // namespace
}  // namespace terrane::core
