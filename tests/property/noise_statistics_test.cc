// The random numbers under everything: normal to Kolmogorov-Smirnov 0.002, and
// without a trace of their keys. Bounds are four standard deviations of the
// estimate, unless said otherwise; the draws are fixed, so a run never differs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/noise/counter_hash.h"
#include "core/noise/normal.h"
#include "tests/property/estimators.h"

namespace terrane::core {
namespace {

constexpr int kDraws = 1'000'000;

// What a displacement is drawn by.
struct Key {
  std::int64_t seed = 1;
  std::uint32_t stream = 20;  // 2 * level + half step
  std::int64_t x = 0;
  std::int64_t y = 0;
};

std::uint32_t BitsOf(const Key& key) {
  return HashLane(ColumnWord(key.x),
                  MakeRowKey(StreamKey(key.seed, key.stream), key.y));
}

double NormalOf(const Key& key) {
  return static_cast<double>(NormalFromBits(BitsOf(key)));
}

// Ways to walk from draw to draw: an image's, and along each part of the key.
struct Walk {
  const char* name;
  std::function<Key(std::int64_t)> key;
};

const Walk kWalks[] = {
    {"plane",
     [](std::int64_t k) {
       return Key{1, 20, k % 1000 - 500, k / 1000 - 500};
     }},
    {"row",
     [](std::int64_t k) {
       return Key{2, 21, k, -3};
     }},
    {"column",
     [](std::int64_t k) {
       return Key{3, 22, 12345, k};
     }},
    {"far away",
     [](std::int64_t k) {
       return Key{4, 60, (std::int64_t{1} << 50) + k % 1000,
                  -(std::int64_t{1} << 50) + k / 1000};
     }},
    {"seeds",
     [](std::int64_t k) {
       return Key{k, 20, 7, 9};
     }},
    {"streams and seeds",
     [](std::int64_t k) {
       return Key{k / 80, static_cast<std::uint32_t>(k % 80), 7, 9};
     }},
};

TEST(NormalDraw, HasTheMomentsOfANormalDistribution) {
  for (const Walk& walk : kWalks) {
    SCOPED_TRACE(walk.name);
    std::array<double, 5> moments = {};
    for (int k = 0; k < kDraws; ++k) {
      const double z = NormalOf(walk.key(k));
      double power = 1;
      for (double& moment : moments) {
        moment += power / kDraws;
        power *= z;
      }
    }
    const double four = 4 / std::sqrt(kDraws);
    EXPECT_NEAR(moments[1], 0, four);
    EXPECT_NEAR(moments[2], 1, four * std::sqrt(2));
    EXPECT_NEAR(moments[3], 0, four * std::sqrt(15));
    EXPECT_NEAR(moments[4], 3, four * std::sqrt(96));
  }
}

TEST(NormalDraw, IsWithinTwoThousandthsOfNormal) {
  for (const Walk& walk : kWalks) {
    std::vector<float> draws;
    for (int k = 0; k < kDraws; ++k) {
      draws.push_back(NormalFromBits(BitsOf(walk.key(k))));
    }
    const double distance = KolmogorovSmirnov(draws);
    EXPECT_LE(distance, 0.002) << walk.name;
    RecordProperty("kolmogorov_smirnov_" + std::string(walk.name),
                   std::to_string(distance));
  }
}

TEST(NormalDraw, StaysBelowItsMaximumAndIsSymmetric) {
  float largest = 0;
  for (std::uint32_t high = 0; high <= 0xFFFF; ++high) {
    for (const std::uint32_t low : {0u, high, 0xFFFFu - high, 0xFFFFu}) {
      const std::uint32_t bits = high << 16 | low;
      largest = std::max(largest, std::fabs(NormalFromBits(bits)));
      ASSERT_EQ(NormalFromBits(bits), -NormalFromBits(~bits));
    }
  }
  EXPECT_LE(largest, kNormalMaximum);
  EXPECT_GT(largest, kNormalMaximum - 0.01f);
}

TEST(NormalDraw, ShowsNoCorrelationBetweenNeighbouringKeys) {
  struct Neighbour {
    const char* name;
    std::function<Key(Key)> of;
  };
  const Neighbour neighbours[] = {
      {"x + 1", [](Key k) { return ++k.x, k; }},
      {"x + 2", [](Key k) { return k.x += 2, k; }},
      {"y + 1", [](Key k) { return ++k.y, k; }},
      {"y + 2", [](Key k) { return k.y += 2, k; }},
      {"diagonal", [](Key k) { return ++k.x, ++k.y, k; }},
      {"other diagonal", [](Key k) { return --k.x, ++k.y, k; }},
      {"-x", [](Key k) { return k.x = -k.x - 1, k; }},
      {"-y", [](Key k) { return k.y = -k.y - 1, k; }},
      {"x and y swapped", [](Key k) { return std::swap(k.x, ++k.y), k; }},
      {"next half step", [](Key k) { return ++k.stream, k; }},
      {"next level", [](Key k) { return k.stream += 2, k; }},
      {"the child of the next level",
       [](Key k) { return k.stream += 2, k.x *= 2, k.y *= 2, k; }},
      {"seed + 1", [](Key k) { return ++k.seed, k; }},
      {"seed + 2^32", [](Key k) { return k.seed += std::int64_t{1} << 32, k; }},
  };
  for (const Walk& walk : kWalks) {
    for (const Neighbour& neighbour : neighbours) {
      Correlation correlation;
      for (int k = 0; k < kDraws / 4; ++k) {
        // Draws that are correlated with themselves say nothing.
        const Key key = walk.key(k);
        const Key other = neighbour.of(key);
        if (key.x == other.x && key.y == other.y && key.seed == other.seed &&
            key.stream == other.stream) {
          continue;
        }
        correlation.Add(NormalOf(key), NormalOf(other));
      }
      EXPECT_LT(std::fabs(correlation.InDeviations()), 4)
          << walk.name << ": " << neighbour.name;
    }
  }
}

// Every bit that goes in changes every bit that comes out, half of the time.
TEST(Hash, AvalanchesFromEveryBitOfItsKey) {
  constexpr int kKeys = 4000;
  // Five standard deviations: 224 x 32 pairs are looked at.
  const double bound = 5 * 0.5 / std::sqrt(kKeys);
  double worst = 0;
  for (int in = 0; in < 4 * 64; ++in) {
    const int field = in / 64;
    const int bit = in % 64;
    if (field == 3 && bit >= 32) continue;  // streams have 32 bits
    std::array<int, 32> flips = {};
    for (int k = 0; k < kKeys; ++k) {
      Key key = {static_cast<std::int64_t>(Mix64(std::uint64_t(k))),
                 static_cast<std::uint32_t>(k % 80), 37 * k - 5000, 1000 - k};
      const std::uint32_t before = BitsOf(key);
      const auto flip = [bit](std::int64_t* value) {
        *value ^= static_cast<std::int64_t>(std::uint64_t{1} << bit);
      };
      if (field == 0) flip(&key.seed);
      if (field == 1) flip(&key.x);
      if (field == 2) flip(&key.y);
      if (field == 3) key.stream ^= std::uint32_t{1} << bit;
      const std::uint32_t changed = before ^ BitsOf(key);
      for (std::size_t out = 0; out < 32; ++out) {
        flips[out] += static_cast<int>(changed >> out & 1);
      }
    }
    for (const int flipped : flips) {
      worst = std::max(worst, std::fabs(double(flipped) / kKeys - 0.5));
    }
  }
  EXPECT_LT(worst, bound);
  RecordProperty("worst_avalanche_bias", std::to_string(worst));
}

// Each byte of the bits is uniform: chi-square of 256 bins, four deviations.
TEST(Hash, FillsEveryByteEvenly) {
  for (const Walk& walk : kWalks) {
    std::array<std::array<int, 256>, 4> bins = {};
    for (int k = 0; k < kDraws; ++k) {
      const std::uint32_t bits = BitsOf(walk.key(k));
      for (std::size_t byte = 0; byte < 4; ++byte) {
        ++bins[byte][bits >> 8 * byte & 0xFF];
      }
    }
    for (const auto& byte : bins) {
      const double expected = kDraws / 256.0;
      double chi_square = 0;
      for (const int count : byte) {
        chi_square += (count - expected) * (count - expected) / expected;
      }
      EXPECT_NEAR(chi_square, 255, 4 * std::sqrt(2 * 255.0)) << walk.name;
    }
  }
}

}  // namespace
}  // namespace terrane::core
