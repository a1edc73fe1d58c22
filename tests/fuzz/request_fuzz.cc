// Parse, validate and price a request of each generator, and make the terrain
// ready or grow the tree when that is cheap, whatever the bytes: it never
// crashes, and an error is always one that the API documents. The same bytes
// are read as a request of each.
//
// Built as a libFuzzer target (TERRANE_FUZZERS, Clang; the bytes are a
// serialized request or, when they start with '{', protobuf JSON) and, in every
// build, as a test that replays tests/fuzz/corpus: request holds seeds of
// StreamTiles, surface of StreamSurface, tree of StreamTreeMesh, forest of
// StreamForest, flower of StreamFlower, render of StreamRender.
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "core/base/violations.h"
#include "server/actor/actor.h"
#include "terrane/v1/surface.pb.h"
#include "terrane/v1/terrain.pb.h"

namespace terrane::server {

template <typename Request>
bool ParseRequest(const std::string& bytes, Request* request) {
  if (!bytes.starts_with('{')) return request->ParseFromString(bytes);
  return google::protobuf::util::JsonStringToMessage(bytes, request).ok();
}

Actor& TheActor() {
  static const std::unique_ptr<Actor> actor = MakeActor({}, 1);
  return *actor;
}

bool IsDocumented(const absl::Status& error) {
  return absl::IsNotFound(error) || absl::IsResourceExhausted(error) ||
         (absl::IsInvalidArgument(error) && !core::ViolationsOf(error).empty());
}

bool PreparationKeepsContract(const v1::TerrainChoice& terrain) {
  v1::PrepareTerrainRequest request;
  *request.mutable_terrain() = terrain;
  double last = 0;
  bool rises = true;
  const auto prepared = TheActor().PrepareTerrain(
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

bool TerrainKeepsContract(const std::string& bytes) {
  constexpr double kCheapSeconds = 0.05;
  v1::EstimateTilesRequest request;
  if (!ParseRequest(bytes, request.mutable_request())) return true;
  const auto estimate = TheActor().EstimateTiles(request, {});
  if (!estimate.ok()) return IsDocumented(estimate.status());
  if (estimate->tiles() < 0 || estimate->samples() < 0 ||
      estimate->samples() > (std::int64_t{1} << 36) ||
      estimate->generated_points() < estimate->samples() ||
      !(estimate->cpu_seconds() >= 0) || !(estimate->prepare_seconds() >= 0) ||
      estimate->prepare_bytes() < 0) {
    return false;
  }
  return estimate->prepare_seconds() > kCheapSeconds ||
         PreparationKeepsContract(request.request().terrain());
}

bool SurfaceKeepsContract(const std::string& bytes) {
  v1::EstimateSurfaceRequest request;
  if (!ParseRequest(bytes, request.mutable_request())) return true;
  const auto estimate = TheActor().surfaces().Estimate(request);
  if (!estimate.ok()) return IsDocumented(estimate.status());
  return estimate->tiles() >= 0 && estimate->samples() >= 0 &&
         estimate->samples() <= (std::int64_t{1} << 36) &&
         estimate->generated_samples() >= estimate->samples() &&
         estimate->cpu_seconds() >= 0;
}

// Reads messages until the run ends, at most `most`.
template <typename Message>
bool RunKeepsContract(OpenedRun<Message> run, int most) {
  if (!run.ok()) return IsDocumented(run.status());
  Message message;
  for (int k = 0; k < most && !(*run)->Done(); ++k) {
    const absl::Status status = (*run)->Next({}, &message);
    if (!status.ok()) return IsDocumented(status);
    if ((*run)->last_items() < 0) return false;
  }
  return true;
}

bool TreeKeepsContract(const std::string& bytes) {
  constexpr int kFewMessages = 3;
  v1::StreamTreeMeshRequest mesh;
  if (ParseRequest(bytes, &mesh)) {
    v1::EstimateTreeRequest request;
    *request.mutable_tree() = mesh.tree();
    const auto estimate = TheActor().trees().Estimate(request);
    if (!estimate.ok()) return IsDocumented(estimate.status());
    if (estimate->segments_most() < 1 || estimate->memory_bytes_most() < 0 ||
        !(estimate->cpu_seconds_most() >= 0)) {
      return false;
    }
    // Blocks that are left out are made all the same.
    mesh.set_first_block(std::min<std::int64_t>(mesh.first_block(), 2));
    v1::StreamTreeLeavesRequest leaves;
    *leaves.mutable_tree() = mesh.tree();
    if (!RunKeepsContract(TheActor().trees().OpenMesh(mesh), kFewMessages) ||
        !RunKeepsContract(TheActor().trees().OpenLeaves(leaves),
                          kFewMessages)) {
      return false;
    }
  }
  v1::StreamForestRequest forest;
  return !ParseRequest(bytes, &forest) ||
         RunKeepsContract(TheActor().trees().OpenForest(forest), kFewMessages);
}

bool FlowerKeepsContract(const std::string& bytes) {
  constexpr std::int64_t kFewBytes = 4 << 20;
  v1::StreamFlowerRequest request;
  if (!ParseRequest(bytes, &request)) return true;
  v1::EstimateFlowerRequest price;
  *price.mutable_flower() = request.flower();
  const auto estimate = TheActor().flowers().Estimate(price);
  if (!estimate.ok()) return IsDocumented(estimate.status());
  if (estimate->prototypes() < 1 || estimate->instances() < 1 ||
      !(estimate->cpu_seconds() >= 0)) {
    return false;
  }
  return estimate->prototype_bytes() > kFewBytes ||
         RunKeepsContract(TheActor().flowers().Open(request), 5);
}

bool RenderKeepsContract(const std::string& bytes) {
  constexpr int kFewMessages = 4;
  constexpr std::int64_t kFewTriangles = 20'000;
  constexpr std::int64_t kFewPaths = 20'000;
  v1::EstimateRenderRequest request;
  if (!ParseRequest(bytes, request.mutable_request())) return true;
  const auto estimate = TheActor().renders().Estimate(request, {});
  if (!estimate.ok()) return IsDocumented(estimate.status());
  if (estimate->bands() < 0 || estimate->data_bytes() < 0 ||
      estimate->triangles_most() < 1 || estimate->paths() < 1 ||
      !(estimate->cpu_seconds() >= 0) || estimate->memory_bytes_most() < 1) {
    return false;
  }
  // A terrain may take long to prepare.
  return request.request().has_terrain() ||
         estimate->triangles_most() > kFewTriangles ||
         estimate->paths() > kFewPaths ||
         RunKeepsContract(TheActor().renders().Open(request.request(), {}),
                          kFewMessages);
}

// False when an answer breaks the contract.
bool RequestKeepsContract(const std::string& bytes) {
  return TerrainKeepsContract(bytes) && SurfaceKeepsContract(bytes) &&
         TreeKeepsContract(bytes) && FlowerKeepsContract(bytes) &&
         RenderKeepsContract(bytes);
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
#include <vector>

namespace terrane::server {
namespace {

std::vector<std::filesystem::path> Seeds(const std::string& folder) {
  std::vector<std::filesystem::path> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(TERRANE_FUZZ_CORPUS) / folder)) {
    seeds.push_back(entry.path());
  }
  return seeds;
}

std::string BytesOf(const std::filesystem::path& seed) {
  std::ostringstream bytes;
  bytes << std::ifstream(seed, std::ios::binary).rdbuf();
  return bytes.str();
}

TEST(RequestFuzzTest, CorpusKeepsTheContract) {
  for (const char* folder :
       {"request", "surface", "tree", "forest", "flower", "render"}) {
    const std::vector<std::filesystem::path> seeds = Seeds(folder);
    for (const std::filesystem::path& seed : seeds) {
      EXPECT_TRUE(RequestKeepsContract(BytesOf(seed))) << seed.filename();
    }
    EXPECT_GE(seeds.size(), 6u) << folder;
  }
}

// The seeds are worth something only while they still parse.
template <typename Request>
void ExpectJsonSeedsAre(const std::string& folder) {
  for (const std::filesystem::path& seed : Seeds(folder)) {
    if (seed.extension() != ".json") continue;
    Request request;
    EXPECT_TRUE(ParseRequest(BytesOf(seed), &request)) << seed.filename();
  }
}

TEST(RequestFuzzTest, JsonSeedsAreRequests) {
  ExpectJsonSeedsAre<v1::StreamTilesRequest>("request");
  ExpectJsonSeedsAre<v1::StreamSurfaceRequest>("surface");
  ExpectJsonSeedsAre<v1::StreamTreeMeshRequest>("tree");
  ExpectJsonSeedsAre<v1::StreamForestRequest>("forest");
  ExpectJsonSeedsAre<v1::StreamFlowerRequest>("flower");
  ExpectJsonSeedsAre<v1::StreamRenderRequest>("render");
}

}  // namespace
}  // namespace terrane::server

#endif
