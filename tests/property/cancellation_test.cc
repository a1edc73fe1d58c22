// A stop is heard soon, counted in work done after it and not in time.
//
// The clock is the program's memory: a recipe with continuous constraints takes
// memory in every half step of every level of every block, so an operator new
// that counts is a measure of work, and can ask for the stop in the midst of
// it. (Hence a program of its own.)
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <stop_token>
#include <vector>

#include "core/terrain/terrain.h"

namespace {

std::atomic<std::int64_t> allocations = 0;
std::atomic<std::int64_t> stop_at = std::numeric_limits<std::int64_t>::max();
std::stop_source* stop_source = nullptr;

void* CountAndAllocate(std::size_t size) {
  if (++allocations == stop_at) stop_source->request_stop();
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

#ifndef __clang__
// With some flags GCC sees through operator delete but not through operator
// new.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void* operator new(std::size_t size) { return CountAndAllocate(size); }
void* operator new[](std::size_t size) { return CountAndAllocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace terrane::core {
namespace {

constexpr TileRequest kRequest = {12, Sampling::kPoint, {-100, 300, 900, 800}};

class Cancellation : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    TerrainSpec spec;
    spec.dimensions = GetParam();
    for (const ConstraintQuantity quantity :
         {ConstraintQuantity::kRoughness, ConstraintQuantity::kFidelity}) {
      ContinuousConstraint everywhere;
      everywhere.quantity = quantity;
      everywhere.target = 0.6;
      everywhere.reach = 1e9;
      everywhere.vertices = {{0, 0}};
      spec.continuous_constraints.push_back(everywhere);
    }
    auto terrain = Terrain::Create(spec);
    ASSERT_TRUE(terrain.ok()) << terrain.status();
    terrain_ = *std::move(terrain);
    request_ = kRequest;
    if (GetParam() == 1) request_.window = {0, 0, 1 << 14, 1};
    out_.resize(static_cast<std::size_t>(request_.window.width *
                                         request_.window.height));
  }

  void TearDown() override {
    stop_at = std::numeric_limits<std::int64_t>::max();
  }

  absl::Status Generate(std::stop_token stop) {
    return terrain_->Generate(request_, std::move(stop), &scratch_, out_);
  }

  std::shared_ptr<const Terrain> terrain_;
  TileRequest request_;
  TileScratch scratch_;
  std::vector<float> out_;
};

TEST_P(Cancellation, BeforeTheStartGivesCancelled) {
  std::stop_source source;
  source.request_stop();
  const std::int64_t before = allocations;
  const absl::Status status = Generate(source.get_token());
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled) << status;
  EXPECT_LT(allocations - before, 40);
}

TEST_P(Cancellation, InTheMiddleStopsWithinALevelOfABlock) {
  ASSERT_TRUE(Generate({}).ok());  // the scratch grows
  const std::int64_t before_all = allocations;
  ASSERT_TRUE(Generate({}).ok());
  const std::int64_t all = allocations - before_all;
  ASSERT_GT(all, 1000);
  for (const int percent : {1, 10, 50, 90}) {
    std::stop_source source;
    stop_source = &source;
    const std::int64_t start = allocations;
    stop_at = start + all * percent / 100;
    const absl::Status status = Generate(source.get_token());
    EXPECT_EQ(status.code(), absl::StatusCode::kCancelled) << status;
    // At most one level's fields are still computed.
    EXPECT_LT(allocations - stop_at, 60) << "stopped after " << percent << " %";
  }
}

TEST_P(Cancellation, LeavesNothingBehindInTheScratch) {
  ASSERT_TRUE(Generate({}).ok());
  const std::vector<float> expected = out_;
  std::stop_source source;
  stop_source = &source;
  stop_at = allocations + 500;
  ASSERT_FALSE(Generate(source.get_token()).ok());
  ASSERT_TRUE(Generate({}).ok());
  EXPECT_EQ(out_, expected);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Cancellation, testing::Values(1, 2));

}  // namespace
}  // namespace terrane::core
