// The cache of prepared terrains: made once for everyone who waits, ended when
// nobody does, bounded in bytes.
#include "server/actor/terrain_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

#include "tests/server/fake_actor.h"

namespace terrane::server {
namespace {

// Makes real terrains, but only when it is let: until then it is at work, and
// ends when its stop token says so.
class SlowCreate {
 public:
  absl::StatusOr<std::shared_ptr<const core::Terrain>> operator()(
      core::TerrainSpec spec, const core::Preparation& preparation) {
    ++started;
    if (preparation.progress) preparation.progress(0.5);
    while (!released) {
      if (preparation.stop.stop_requested()) {
        ++stopped;
        return absl::CancelledError("stopped");
      }
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return core::Terrain::Create(std::move(spec));
  }

  std::atomic<bool> released = false;
  std::atomic<int> started = 0;
  std::atomic<int> stopped = 0;
};

v1::TerrainRecipe Recipe(std::int64_t seed) {
  v1::TerrainRecipe recipe;
  recipe.set_seed(seed);
  return recipe;
}

class TerrainCacheTest : public ::testing::Test {
 protected:
  TerrainCache::Result Prepare(const v1::TerrainRecipe& recipe,
                               const core::Preparation& preparation = {}) {
    core::Violations violations;
    const ReadRecipe read = ReadTerrainRecipe(recipe, {}, {}, "", &violations);
    EXPECT_TRUE(violations.empty());
    return cache_.Prepare(recipe, read, preparation);
  }
  std::future<TerrainCache::Result> PrepareAside(
      const v1::TerrainRecipe& recipe, core::Preparation preparation = {}) {
    return std::async(std::launch::async,
                      [=, this] { return Prepare(recipe, preparation); });
  }
  // A progress callback that counts its calls.
  static core::Preparation Watched(std::atomic<int>* calls,
                                   std::stop_token stop = {}) {
    return {std::move(stop), [calls](double fraction) {
              EXPECT_EQ(fraction, 0.5);
              ++*calls;
            }};
  }

  SlowCreate create_;
  TerrainCache cache_{std::int64_t{1} << 20, std::ref(create_)};
};

TEST_F(TerrainCacheTest, ConcurrentCallersShareOneTerrainAndItsProgress) {
  std::atomic<int> first_calls = 0;
  std::atomic<int> second_calls = 0;
  auto first = PrepareAside(Recipe(1), Watched(&first_calls));
  ASSERT_TRUE(Eventually([&] { return create_.started == 1; }));
  auto second = PrepareAside(Recipe(1), Watched(&second_calls));
  ASSERT_TRUE(Eventually([&] { return second_calls == 1; }));
  create_.released = true;
  const TerrainCache::Result one = first.get();
  const TerrainCache::Result two = second.get();
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_EQ(*one, *two);
  EXPECT_EQ(*one, *Prepare(Recipe(1)));
  EXPECT_EQ(create_.started, 1);
  EXPECT_EQ(first_calls, 1);
}

TEST_F(TerrainCacheTest, OtherRecipesDoNotWait) {
  create_.released = true;
  const auto first = Prepare(Recipe(1));
  const auto second = Prepare(Recipe(2));
  EXPECT_NE((*first)->recipe_hash, (*second)->recipe_hash);
  EXPECT_EQ(create_.started, 2);
}

TEST_F(TerrainCacheTest, ResolvedRecipeIsTheSameTerrain) {
  create_.released = true;
  const auto made = Prepare(Recipe(1));
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(*Prepare((*made)->recipe), *made);
  v1::TerrainRecipe spelled = Recipe(1);
  spelled.set_dimensions(2);
  EXPECT_EQ((*Prepare(spelled))->recipe_hash, (*made)->recipe_hash);
  // It was made to find that out, and took the place of the first.
  EXPECT_EQ(create_.started, 2);
  EXPECT_EQ(cache_.kept_bytes(), (*made)->memory_bytes);
}

TEST_F(TerrainCacheTest, LastCallerToGiveUpEndsTheWork) {
  std::stop_source stop;
  auto only = PrepareAside(Recipe(1), {stop.get_token(), {}});
  ASSERT_TRUE(Eventually([&] { return create_.started == 1; }));
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled(only.get().status()));
  EXPECT_EQ(create_.stopped, 1);
  // Nothing of it is kept.
  create_.released = true;
  EXPECT_TRUE(Prepare(Recipe(1)).ok());
  EXPECT_EQ(create_.started, 2);
}

TEST_F(TerrainCacheTest, WorkGoesOnForWhoStillWaits) {
  std::stop_source stop;
  std::atomic<int> calls = 0;
  auto first = PrepareAside(Recipe(1), {stop.get_token(), {}});
  ASSERT_TRUE(Eventually([&] { return create_.started == 1; }));
  auto second = PrepareAside(Recipe(1), Watched(&calls));
  ASSERT_TRUE(Eventually([&] { return calls == 1; }));
  stop.request_stop();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(create_.stopped, 0);
  create_.released = true;
  EXPECT_TRUE(second.get().ok());
  EXPECT_TRUE(absl::IsCancelled(first.get().status()));
  EXPECT_EQ(create_.started, 1);
}

TEST_F(TerrainCacheTest, WaitingCallerLeavesAtOnce) {
  std::stop_source stop;
  std::atomic<int> calls = 0;
  auto first = PrepareAside(Recipe(1));
  ASSERT_TRUE(Eventually([&] { return create_.started == 1; }));
  auto second = PrepareAside(Recipe(1), Watched(&calls, stop.get_token()));
  ASSERT_TRUE(Eventually([&] { return calls == 1; }));
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled(second.get().status()));
  EXPECT_EQ(create_.stopped, 0);
  create_.released = true;
  EXPECT_TRUE(first.get().ok());
}

TEST_F(TerrainCacheTest, CallerThatGaveUpBeforeItCameMakesNothing) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(
      absl::IsCancelled(Prepare(Recipe(1), {stop.get_token(), {}}).status()));
  EXPECT_EQ(cache_.kept_bytes(), 0);
}

// Each recipe of 1,000 cones takes some 100 KB, the cache 1 MB.
TEST_F(TerrainCacheTest, LeastRecentlyUsedGoesFirst) {
  create_.released = true;
  const auto large = [](std::int64_t seed) {
    v1::TerrainRecipe recipe = Recipe(seed);
    for (int i = 0; i < 1000; ++i) {
      v1::Cone* cone = recipe.mutable_macro()->add_parts()->mutable_cone();
      cone->mutable_centre()->set_x(i + 0.5);
      cone->mutable_centre()->set_y(i + 0.5);
      cone->set_radius(3.5);
      cone->set_height(4.5);
    }
    return recipe;
  };
  const auto kept = Prepare(large(0));
  const std::int64_t each = cache_.kept_bytes();
  EXPECT_EQ(each, (*kept)->memory_bytes);
  EXPECT_GT(each, 50'000);
  const int fit = static_cast<int>((std::int64_t{1} << 20) / each);
  for (int seed = 1; seed < fit; ++seed) {
    EXPECT_TRUE(Prepare(large(seed)).ok());
  }
  EXPECT_EQ(create_.started, fit);
  EXPECT_EQ(*kept, *Prepare(large(0)));  // now the latest used
  EXPECT_TRUE(Prepare(large(fit)).ok());
  EXPECT_LE(cache_.kept_bytes(), std::int64_t{1} << 20);
  EXPECT_EQ(*kept, *Prepare(large(0)));
  EXPECT_EQ(create_.started, fit + 1);
  EXPECT_TRUE(Prepare(large(1)).ok());  // was the least recently used
  EXPECT_EQ(create_.started, fit + 2);
}

TEST_F(TerrainCacheTest, FailuresAreNotKept) {
  int calls = 0;
  TerrainCache cache(
      1 << 20,
      [&](core::TerrainSpec, const core::Preparation&)
          -> absl::StatusOr<std::shared_ptr<const core::Terrain>> {
        ++calls;
        return absl::InvalidArgumentError("no");
      });
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(cache.Prepare(Recipe(1), {}, {}).status().message(), "no");
  }
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(cache.kept_bytes(), 0);
}

}  // namespace
}  // namespace terrane::server
