// Parse, validate and price a StreamTiles request, whatever the bytes: it never
// crashes, and an error is always one that the API documents.
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

// False when the answer breaks the contract.
bool EstimateKeepsContract(const std::string& bytes) {
  static const std::unique_ptr<Actor> actor = MakeActor({}, 1);
  v1::EstimateTilesRequest request;
  if (!ParseRequest(bytes, request.mutable_request())) return true;
  const auto estimate = actor->EstimateTiles(request);
  if (!estimate.ok()) {
    return absl::IsNotFound(estimate.status()) ||
           (absl::IsInvalidArgument(estimate.status()) &&
            !core::ViolationsOf(estimate.status()).empty());
  }
  return estimate->tiles() >= 0 && estimate->samples() >= 0 &&
         estimate->samples() <= (std::int64_t{1} << 36) &&
         estimate->generated_points() >= estimate->samples() &&
         estimate->cpu_seconds() >= 0;
}

}  // namespace terrane::server

#ifdef TERRANE_LIBFUZZER

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!terrane::server::EstimateKeepsContract(bytes)) std::abort();
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
    EXPECT_TRUE(EstimateKeepsContract(bytes.str())) << entry.path().filename();
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
