#include "core/terrain/gram_system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace terrane::core {
namespace {

// Spots along a line whose rows overlap: W W' + D is well conditioned but far
// from diagonal.
struct System {
  GramMatrix matrix;
  std::vector<GramPlace> places;
  std::vector<std::vector<double>> dense;
  std::vector<double> right;
};

constexpr std::size_t kColumns = 60;

System MakeSystem(std::size_t rows) {
  System system;
  std::mt19937_64 engine(9);
  std::uniform_real_distribution<double> draw(-1, 1);
  std::vector<std::vector<double>> w(rows, std::vector<double>(kColumns, 0.0));
  system.dense.assign(rows, std::vector<double>(rows, 0.0));
  for (std::size_t k = 0; k < rows; ++k) {
    for (std::size_t c = 0; c < kColumns; c += 1 + engine() % 9) {
      w[k][c] = draw(engine);
      system.matrix.Append(static_cast<std::uint32_t>(c), w[k][c]);
    }
    const double own = 0.1 + 0.01 * static_cast<double>(k);
    system.matrix.EndRow(own);
    system.dense[k][k] = own;
    system.places.push_back({static_cast<double>(k) / 7, draw(engine)});
    system.right.push_back(draw(engine));
  }
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      for (std::size_t c = 0; c < kColumns; ++c) {
        system.dense[i][j] += w[i][c] * w[j][c];
      }
    }
  }
  return system;
}

TEST(GramSystemTest, ProductIsThatOfTheDenseMatrix) {
  const System system = MakeSystem(40);
  std::vector<double> shared(kColumns);
  std::vector<double> product(40);
  system.matrix.Product(system.right, shared, product);
  for (std::size_t i = 0; i < 40; ++i) {
    double expected = 0;
    for (std::size_t j = 0; j < 40; ++j) {
      expected += system.dense[i][j] * system.right[j];
    }
    EXPECT_NEAR(product[i], expected, 1e-12);
  }
}

TEST(GramSystemTest, SolvesAndReportsTheTrueResidual) {
  const System system = MakeSystem(40);
  const auto solution =
      SolveGram(system.matrix, kColumns, system.places, 0.8, system.right, {});
  ASSERT_TRUE(solution.ok());
  EXPECT_GT(solution->iterations, 1);
  EXPECT_LT(solution->worst_residual, 3e-8);
  for (std::size_t i = 0; i < 40; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < 40; ++j) {
      sum += system.dense[i][j] * solution->x[j];
    }
    EXPECT_NEAR(sum, system.right[i], 1e-7);
  }
}

TEST(GramSystemTest, StopsWhenAsked) {
  const System system = MakeSystem(40);
  std::stop_source stop;
  stop.request_stop();
  Preparation preparation;
  preparation.stop = stop.get_token();
  EXPECT_EQ(SolveGram(system.matrix, kColumns, system.places, 0.8, system.right,
                      preparation)
                .status()
                .code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace terrane::core
