// Parse, validate and price a StreamTiles request, and make its terrain ready
// when that is cheap, whatever the bytes: it never crashes, and an error is
// always one that the API documents.
//
// Built as a libFuzzer target (TERRANE_FUZZERS, Clang; the bytes are a
// serialized request or, when they start with '{', protobuf JSON) and, in every
// build, as a test that replays tests/fuzz/corpus/request.
#include <google/protobuf/util/json_util.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "core/base/violations.h"
#include "server/actor/actor.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::server {

bool ParseRequest(const std::string& bytes, v1::StreamTilesRequest* request) {
  if (!bytes.starts_with('{')) return request->ParseFromString(bytes);
  return google::protobuf::util::JsonStringToMessage(bytes, request).ok();
}

bool IsDocumented(const absl::Status& error) {
  return absl::IsNotFound(error) || absl::IsResourceExhausted(error) ||
         (absl::IsInvalidArgument(error) && !core::ViolationsOf(error).empty());
}

bool PreparationKeepsContract(const v1::TerrainChoice& terrain, Actor* actor) {
  v1::PrepareTerrainRequest request;
  *request.mutable_terrain() = terrain;
  double last = 0;
  bool rises = true;
  const auto prepared = actor->PrepareTerrain(
      request,
      [&](double fraction) {
        rises = rises && fraction >= last && fraction <= 1;
        last = fraction;
      },
      {});
  if (!prepared.ok()) return IsDocumented(prepared.status());
  return rises && prepared->memory_bytes() >= 0 &&
         !prepared->recipe_hash().empty();
}

// False when an answer breaks the contract.
bool RequestKeepsContract(const std::string& bytes) {
  static const std::unique_ptr<Actor> actor = MakeActor({}, 1);
  constexpr double kCheapSeconds = 0.05;
  v1::EstimateTilesRequest request;
  if (!ParseRequest(bytes, request.mutable_request())) return true;
  const auto estimate = actor->EstimateTiles(request);
  if (!estimate.ok()) return IsDocumented(estimate.status());
  if (estimate->tiles() < 0 || estimate->samples() < 0 ||
      estimate->samples() > (std::int64_t{1} << 36) ||
      estimate->generated_points() < estimate->samples() ||
      !(estimate->cpu_seconds() >= 0) || !(estimate->prepare_seconds() >= 0) ||
      estimate->prepare_bytes() < 0) {
    return false;
  }
  return estimate->prepare_seconds() > kCheapSeconds ||
         PreparationKeepsContract(request.request().terrain(), actor.get());
}

}  // namespace terrane::server

#ifdef TERRANE_LIBFUZZER

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!terrane::server::RequestKeepsContract(bytes)) std::abort();
  return 0;
}

#else

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace terrane::server {
namespace {

TEST(RequestFuzzTest, CorpusKeepsTheContract) {
  int seeds = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(TERRANE_REQUEST_CORPUS)) {
    std::ostringstream bytes;
    bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    EXPECT_TRUE(RequestKeepsContract(bytes.str())) << entry.path().filename();
    ++seeds;
  }
  EXPECT_GE(seeds, 10);
}

// The seeds are worth something only while they still parse.
TEST(RequestFuzzTest, JsonSeedsAreRequests) {
  for (const auto& entry :
       std::filesystem::directory_iterator(TERRANE_REQUEST_CORPUS)) {
    if (entry.path().extension() != ".json") continue;
    std::ostringstream bytes;
    bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    v1::StreamTilesRequest request;
    EXPECT_TRUE(ParseRequest(bytes.str(), &request)) << entry.path().filename();
  }
}

}  // namespace
}  // namespace terrane::server

#endif
