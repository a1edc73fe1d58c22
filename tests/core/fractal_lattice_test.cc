// The SIMD lattice against its scalar reference, bit for bit, and bit for bit
// against itself: tiles, seams, nesting, SIMD targets.
#include "core/terrain/fractal_lattice.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "hwy/targets.h"
#include "tests/core/lattice_reference.h"

namespace terrane::core {
namespace {

constexpr FractalSource kSources[] = {FractalSource::kMidpoint,
                                      FractalSource::kSuccessive,
                                      FractalSource::kSubdivision};

struct Case {
  std::int64_t seed = 1;
  FractalSource source = FractalSource::kSubdivision;
  double roughness = 0.8;
  std::optional<Domain> domain;
  std::vector<DiscreteConstraint> constraints;
};

FractalLattice MakeLattice(const Case& c) {
  TerrainSpec spec;
  spec.domain = c.domain;
  spec.discrete_constraints = c.constraints;
  DeviationModel::Config model;
  model.source = c.source;
  model.mirror = {c.domain};
  model.roughness = c.roughness;
  return FractalLattice(
      {c.seed, c.source, {c.domain}, false}, DeviationModel(model),
      {.constraints = std::make_shared<const DiscreteConstraints>(
           *DiscreteConstraints::Create(spec, Frame{}))});
}

std::vector<float> Values(const FractalLattice& lattice, int level,
                          Sampling sampling, const Window& window) {
  FractalLattice::Scratch scratch;
  const GridView grid = sampling == Sampling::kPoint
                            ? lattice.Points(level, window, {}, &scratch)
                            : lattice.Centres(level, window, {}, &scratch);
  std::vector<float> values;
  for (int j = 0; j < window.height; ++j) {
    for (int i = 0; i < window.width; ++i) values.push_back(grid.At(i, j));
  }
  return values;
}

void ExpectSameBits(float a, float b, std::int64_t x, std::int64_t y) {
  ASSERT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b))
      << a << " and " << b << " at (" << x << ", " << y << ")";
}

void ExpectReference(const Case& c, LatticeReference* reference, int level,
                     Sampling sampling, const Window& window) {
  const std::vector<float> values =
      Values(MakeLattice(c), level, sampling, window);
  std::size_t k = 0;
  for (std::int64_t y = window.y; y < window.y + window.height; ++y) {
    for (std::int64_t x = window.x; x < window.x + window.width; ++x, ++k) {
      const float expected = sampling == Sampling::kPoint
                                 ? reference->Point(level, x, y)
                                 : reference->Area(level, x, y);
      ExpectSameBits(values[k], expected, x, y);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

TEST(FractalLattice, EqualsTheReferenceOnAnEndlessLattice) {
  for (const FractalSource source : kSources) {
    const Case c = {77, source, 0.7, {}, {}};
    LatticeReference reference(c.seed, source, c.roughness, {});
    for (const int level : {0, 1, 2, 5}) {
      for (const Sampling sampling : {Sampling::kPoint, Sampling::kArea}) {
        SCOPED_TRACE(testing::Message()
                     << "source " << int(source) << " level " << level);
        ExpectReference(c, &reference, level, sampling, {-19, 6, 21, 18});
      }
    }
    ExpectReference(
        c, &reference, 30, Sampling::kPoint,
        {(std::int64_t{1} << 50) - 3, -(std::int64_t{1} << 49), 6, 5});
  }
}

TEST(FractalLattice, EqualsTheReferenceAtTheBordersOfABoundedDomain) {
  for (const FractalSource source : kSources) {
    for (const Domain domain : {Domain{1, 1}, Domain{3, 2}}) {
      const Case c = {5, source, 0.6, domain, {}};
      LatticeReference reference(c.seed, source, c.roughness, domain);
      for (const int level : {0, 1, 2, 4}) {
        SCOPED_TRACE(testing::Message()
                     << "source " << int(source) << " level " << level);
        ExpectReference(c, &reference, level, Sampling::kPoint,
                        {0, 0, (domain.cells_x << level) + 1,
                         (domain.cells_y << level) + 1});
        ExpectReference(
            c, &reference, level, Sampling::kArea,
            {0, 0, domain.cells_x << level, domain.cells_y << level});
      }
    }
  }
}

TEST(FractalLattice, EqualsTheReferenceWithDiscreteConstraints) {
  Case c = {9, FractalSource::kMidpoint, 0.8, Domain{2, 2}, {}};
  LatticeReference reference(c.seed, c.source, c.roughness, c.domain);
  // Corner, centre, edge and border points of several levels; world = level 0.
  const struct {
    int level;
    std::int64_t x, y;
  } points[] = {{0, 1, 1}, {1, 1, 3},  {2, 0, 3},  {2, 4, 5},
                {3, 9, 9}, {3, 10, 9}, {4, 32, 17}};
  for (const auto& p : points) {
    DiscreteConstraint constraint;
    constraint.point = {std::ldexp(static_cast<double>(p.x), -p.level),
                        std::ldexp(static_cast<double>(p.y), -p.level)};
    constraint.level = p.level + 1;  // snaps to the same point, found coarser
    c.constraints.push_back(constraint);
    reference.Constrain(p.level, p.x, p.y);
  }
  for (const int level : {0, 1, 2, 3, 4, 5}) {
    const std::int64_t size = (std::int64_t{2} << level) + 1;
    ExpectReference(c, &reference, level, Sampling::kPoint, {0, 0, size, size});
    ExpectReference(c, &reference, level, Sampling::kArea,
                    {0, 0, size - 1, size - 1});
  }
}

TEST(FractalLattice, EverySimdTargetGivesTheSameBits) {
  const Case cases[] = {{3, FractalSource::kMidpoint, 0.5, {}, {}},
                        {4, FractalSource::kSuccessive, 0.8, {}, {}},
                        {5, FractalSource::kSubdivision, 0.95, {}, {}}};
  for (const Case& c : cases) {
    const FractalLattice lattice = MakeLattice(c);
    const Window window = {1234567, -7654321, 67, 41};
    const std::vector<float> best =
        Values(lattice, 20, Sampling::kPoint, window);
    int targets = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      EXPECT_EQ(best, Values(lattice, 20, Sampling::kPoint, window))
          << hwy::TargetName(target);
      ++targets;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GE(targets, 2);
  }
}

}  // namespace
}  // namespace terrane::core
