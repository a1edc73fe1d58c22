// RequestMix: which request is the n-th of a load test.
//
// A pure function of the seed and the number, so that the same options ask the
// same things in the same order, whatever the number of callers and however
// their answers fall. Threads: any.
#ifndef TERRANE_CLIENT_BENCH_REQUEST_MIX_H_
#define TERRANE_CLIENT_BENCH_REQUEST_MIX_H_

#include <array>
#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

namespace terrane::client {

enum class RequestKind { kTiles, kProfiles, kSurfaces, kTrees, kFlowers };
inline constexpr std::size_t kRequestKinds = 5;
inline constexpr std::array<const char*, kRequestKinds> kRequestKindNames = {
    "tiles", "profiles", "surfaces", "trees", "flowers"};

using MixWeights = std::array<double, kRequestKinds>;

// "tiles=8,trees=1": kinds that are not named have weight 0; a name alone has
// weight 1. INVALID_ARGUMENT names what is wrong.
absl::StatusOr<MixWeights> ParseMix(const std::string& text);

struct MixOptions {
  MixWeights weights = {1, 0, 0, 0, 0};
  // Share of the requests for recipes that were never asked for, 0 to 1; the
  // others are for one of `hot_seeds` recipes of their kind.
  double cold_share = 0;
  int hot_seeds = 8;
  // Simulated clients. The first sends `greedy_share` of all requests, the
  // others the rest in equal parts; 0: each sends the same.
  int clients = 1;
  double greedy_share = 0;
  std::uint64_t seed = 1;
};

struct PlannedRequest {
  std::int64_t number = 0;
  RequestKind kind = RequestKind::kTiles;
  std::int64_t seed = 0;    // of the recipe
  std::uint32_t place = 0;  // where in it: any number
  int client = 0;
};

class RequestMix {
 public:
  explicit RequestMix(const MixOptions& options) : options_(options) {}

  PlannedRequest At(std::int64_t number) const;
  const MixOptions& options() const { return options_; }

 private:
  RequestKind KindAt(std::int64_t number) const;
  int ClientAt(std::int64_t number) const;

  MixOptions options_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_REQUEST_MIX_H_
