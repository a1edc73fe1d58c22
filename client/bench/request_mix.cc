#include "client/bench/request_mix.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <string_view>

#include "client/bench/random_number.h"

namespace terrane::client {
namespace {

constexpr double kMaxWeight = 1e6;

absl::Status WrongMix(std::string_view part) {
  std::string text =
      "must be KIND=WEIGHT,... with kinds tiles, profiles, surfaces, trees, "
      "flowers and weights in [0, 1e6], got ";
  text += part;
  return absl::InvalidArgumentError(text);
}

// One "KIND=WEIGHT" or "KIND".
absl::Status AddPart(std::string_view part, MixWeights* weights) {
  const std::size_t equals = part.find('=');
  const std::string_view name = part.substr(0, equals);
  const auto* kind =
      std::find(kRequestKindNames.begin(), kRequestKindNames.end(), name);
  if (kind == kRequestKindNames.end()) return WrongMix(part);
  double weight = 1;
  if (equals != std::string_view::npos) {
    const std::string_view number = part.substr(equals + 1);
    const auto [end, error] =
        std::from_chars(number.data(), number.data() + number.size(), weight);
    if (error != std::errc() || end != number.data() + number.size()) {
      return WrongMix(part);
    }
  }
  if (!(weight >= 0 && weight <= kMaxWeight)) return WrongMix(part);
  (*weights)[static_cast<std::size_t>(kind - kRequestKindNames.begin())] =
      weight;
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<MixWeights> ParseMix(const std::string& text) {
  MixWeights weights = {};
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const absl::Status status = AddPart(rest.substr(0, comma), &weights);
    if (!status.ok()) return status;
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (std::accumulate(weights.begin(), weights.end(), 0.0) <= 0) {
    return absl::InvalidArgumentError(
        "must give one kind a weight above 0, got " + text);
  }
  return weights;
}

PlannedRequest RequestMix::At(std::int64_t number) const {
  const std::uint64_t seed = options_.seed;
  PlannedRequest request;
  request.number = number;
  request.kind = KindAt(number);
  request.client = ClientAt(number);
  request.place = static_cast<std::uint32_t>(
      RandomBits(seed, RandomStream::kPlace, number));
  // Recipes -1, -2, ... are the hot ones; a cold one has the request's number.
  std::int64_t recipe = number;
  if (RandomShare(seed, RandomStream::kCold, number) >= options_.cold_share) {
    const std::uint64_t choice =
        RandomBits(seed, RandomStream::kHotChoice, number);
    recipe = -1 - static_cast<std::int64_t>(
                      choice % static_cast<std::uint64_t>(options_.hot_seeds));
  }
  request.seed = static_cast<std::int64_t>(
      RandomBits(seed, RandomStream::kRecipe, recipe));
  return request;
}

RequestKind RequestMix::KindAt(std::int64_t number) const {
  const MixWeights& weights = options_.weights;
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double left = RandomShare(options_.seed, RandomStream::kKind, number) * total;
  std::size_t last = 0;
  for (std::size_t kind = 0; kind < kRequestKinds; ++kind) {
    if (weights[kind] <= 0) continue;
    last = kind;
    if (left < weights[kind]) break;
    left -= weights[kind];
  }
  return static_cast<RequestKind>(last);
}

int RequestMix::ClientAt(std::int64_t number) const {
  const int clients = options_.clients;
  if (clients == 1) return 0;
  double share = RandomShare(options_.seed, RandomStream::kClient, number);
  if (options_.greedy_share <= 0) return static_cast<int>(share * clients);
  if (share < options_.greedy_share) return 0;
  share = (share - options_.greedy_share) / (1 - options_.greedy_share);
  return 1 + std::min(static_cast<int>(share * (clients - 1)), clients - 2);
}

}  // namespace terrane::client
