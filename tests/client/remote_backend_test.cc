// RemoteBackend against a server that misbehaves on purpose.
#include "client/remote_backend.h"

#include <gmock/gmock.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/base/violations.h"
#include "terrane/v1/common.pb.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kTiles = 6;

v1::HeightTile Tile(std::int64_t index) {
  v1::HeightTile tile;
  tile.set_index(index);
  tile.set_total(kTiles);
  tile.mutable_window()->set_x(index);
  tile.mutable_window()->set_width(1);
  tile.mutable_window()->set_height(1);
  tile.set_data(std::string(4, static_cast<char>('0' + index)));
  tile.set_checksum(XXH3_64bits(tile.data().data(), tile.data().size()));
  return tile;
}

grpc::Status NotKept(const std::string& reason, const std::string& key,
                     const std::string& id) {
  v1::ErrorInfo info;
  info.set_reason(reason);
  info.set_domain("terrane");
  (*info.mutable_metadata())[key] = id;
  v1::ErrorStatus details;
  google::protobuf::Any* detail = details.add_details();
  detail->set_type_url("type.googleapis.com/google.rpc.ErrorInfo");
  detail->set_value(info.SerializeAsString());
  return {grpc::StatusCode::NOT_FOUND, "gone", details.SerializeAsString()};
}

// Serves a stream of kTiles tiles; the tests set how it fails.
class FaultyServer : public v1::TerrainService::Service,
                     public v1::RasterService::Service,
                     public v1::SpotTableService::Service {
 public:
  grpc::Status StreamTiles(
      grpc::ServerContext* context, const v1::StreamTilesRequest* request,
      grpc::ServerWriter<v1::StreamTilesResponse>* writer) override {
    first_tiles.push_back(request->first_tile());
    if (!kept_raster) {
      return NotKept("RASTER_NOT_FOUND", "raster_id", "sha256:r");
    }
    if (!kept_table) {
      return NotKept("SPOT_TABLE_NOT_FOUND", "table_id", "sha256:t");
    }
    v1::StreamTilesResponse message;
    v1::StreamHeader* header = message.mutable_header();
    header->set_tile_size(1);
    header->set_tile_columns(kTiles);
    header->set_tile_rows(1);
    header->mutable_window()->set_width(kTiles);
    header->mutable_window()->set_height(1);
    writer->Write(message);
    for (std::int64_t i = request->first_tile(); i < kTiles; ++i) {
      if (i == request->first_tile() + tiles_before_cut) {
        return {grpc::StatusCode::UNAVAILABLE, "cut"};
      }
      *message.mutable_tile() = Tile(i);
      if (i == damaged_tile) {
        damaged_tile = -1;
        (*message.mutable_tile()->mutable_data())[0] = '?';
      }
      writer->Write(message);
    }
    while (hang && !context->IsCancelled()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    saw_cancel = context->IsCancelled();
    return grpc::Status::OK;
  }

  grpc::Status GetPreset(grpc::ServerContext*, const v1::GetPresetRequest*,
                         v1::GetPresetResponse*) override {
    ++preset_calls;
    return preset_status;
  }

  grpc::Status UploadRaster(grpc::ServerContext*,
                            grpc::ServerReader<v1::UploadRasterRequest>* reader,
                            v1::UploadRasterResponse* response) override {
    v1::UploadRasterRequest part;
    std::string samples;
    while (reader->Read(&part)) samples += part.chunk();
    uploads.push_back(samples.size());
    kept_raster = true;
    response->set_raster_id("sha256:r");
    return grpc::Status::OK;
  }

  grpc::Status UploadSpotTable(
      grpc::ServerContext*,
      grpc::ServerReader<v1::UploadSpotTableRequest>* reader,
      v1::UploadSpotTableResponse* response) override {
    v1::UploadSpotTableRequest part;
    std::string columns;
    while (reader->Read(&part)) columns += part.chunk();
    uploads.push_back(columns.size());
    kept_table = true;
    response->set_table_id("sha256:t");
    return grpc::Status::OK;
  }

  grpc::Status PrepareTerrain(
      grpc::ServerContext*, const v1::PrepareTerrainRequest*,
      grpc::ServerWriter<v1::PrepareTerrainResponse>* writer) override {
    ++prepare_calls;
    v1::PrepareTerrainResponse message;
    for (const double fraction : {0.25, 0.5}) {
      message.mutable_progress()->set_fraction(fraction);
      writer->Write(message);
      if (prepare_calls == cut_prepare_call) {
        return {grpc::StatusCode::UNAVAILABLE, "cut"};
      }
    }
    if (!ends_without_result) {
      message.mutable_prepared()->set_recipe_hash("sha256:p");
      writer->Write(message);
    }
    return grpc::Status::OK;
  }

  std::int64_t tiles_before_cut = kTiles + 1;
  std::atomic<std::int64_t> damaged_tile = -1;
  bool hang = false;
  std::atomic<bool> kept_raster = true;
  std::atomic<bool> kept_table = true;
  int prepare_calls = 0;
  int cut_prepare_call = 0;
  bool ends_without_result = false;
  std::atomic<bool> saw_cancel = false;
  grpc::Status preset_status;
  int preset_calls = 0;
  std::vector<std::int64_t> first_tiles;
  std::vector<std::size_t> uploads;
};

class RemoteBackendTest : public testing::Test {
 protected:
  void SetUp() override {
    int port = 0;
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(),
                             &port);
    builder.RegisterService(
        static_cast<v1::TerrainService::Service*>(&faulty_));
    builder.RegisterService(static_cast<v1::RasterService::Service*>(&faulty_));
    builder.RegisterService(
        static_cast<v1::SpotTableService::Service*>(&faulty_));
    server_ = builder.BuildAndStart();
    ASSERT_NE(server_, nullptr);
    backend_ =
        std::make_unique<RemoteBackend>("127.0.0.1:" + std::to_string(port));
  }
  void TearDown() override { server_->Shutdown(); }

  // Streams all tiles; `received_` gets their bytes in order.
  absl::Status Stream(std::stop_token stop = {}) {
    return backend_->StreamTiles(
        v1::StreamTilesRequest(),
        [&](const v1::StreamHeader&) {
          ++headers_;
          return absl::OkStatus();
        },
        [&](const v1::HeightTile& tile) {
          received_ += tile.data()[0];
          return on_tile_;
        },
        stop);
  }

  FaultyServer faulty_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<RemoteBackend> backend_;
  absl::Status on_tile_;
  std::string received_;
  int headers_ = 0;
};

TEST_F(RemoteBackendTest, CutStreamIsResumedAtTheMissingTile) {
  faulty_.tiles_before_cut = 2;
  EXPECT_EQ(Stream(), absl::OkStatus());
  EXPECT_EQ(received_, "012345");
  EXPECT_EQ(headers_, 1);
  EXPECT_THAT(faulty_.first_tiles, ElementsAre(0, 2, 4));
}

TEST_F(RemoteBackendTest, DamagedTileIsAskedForAgain) {
  faulty_.damaged_tile = 3;
  EXPECT_EQ(Stream(), absl::OkStatus());
  EXPECT_EQ(received_, "012345");
  EXPECT_THAT(faulty_.first_tiles, ElementsAre(0, 3));
}

TEST_F(RemoteBackendTest, StreamThatBringsNothingNewIsGivenUp) {
  faulty_.tiles_before_cut = 0;
  const absl::Status status = Stream();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(faulty_.first_tiles, testing::SizeIs(testing::Le(9U)));
}

TEST_F(RemoteBackendTest, ErrorOfTheReceiverEndsTheStreamAtOnce) {
  on_tile_ = absl::UnknownError("disk full");
  EXPECT_EQ(Stream(), on_tile_);
  EXPECT_EQ(received_, "0");
  EXPECT_THAT(faulty_.first_tiles, ElementsAre(0));
}

TEST_F(RemoteBackendTest, StopCancelsTheStreamOnTheServer) {
  faulty_.hang = true;
  std::stop_source source;
  std::jthread interrupt([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    source.request_stop();
  });
  EXPECT_EQ(Stream(source.get_token()).code(), absl::StatusCode::kCancelled);
  server_->Shutdown();  // waits for the handler
  EXPECT_TRUE(faulty_.saw_cancel);
}

TEST_F(RemoteBackendTest, EvictedRasterIsUploadedAgainOnce) {
  const auto raster = std::make_shared<const core::Raster>(
      core::Raster{600, 500, {}, std::vector<float>(600 * 500, 1.0F)});
  const auto raster_id = backend_->UploadRaster(raster, {});
  ASSERT_TRUE(raster_id.ok()) << raster_id.status();
  faulty_.kept_raster = false;
  EXPECT_EQ(Stream(), absl::OkStatus());
  EXPECT_EQ(received_, "012345");
  EXPECT_THAT(faulty_.uploads, ElementsAre(1'200'000U, 1'200'000U));
}

TEST_F(RemoteBackendTest, EvictedSpotTableIsUploadedAgainBesideARaster) {
  const auto raster = std::make_shared<const core::Raster>(
      core::Raster{2, 2, {}, std::vector<float>(4, 1.0F)});
  const auto table = std::make_shared<const SpotTable>(
      SpotTable{{1, 2}, {3, 4}, {5, 6}, {0, 0.5}, {2, 3}});
  ASSERT_TRUE(backend_->UploadRaster(raster, {}).ok());
  ASSERT_TRUE(backend_->UploadSpotTable(table, {}).ok());
  faulty_.kept_raster = false;
  faulty_.kept_table = false;
  EXPECT_EQ(Stream(), absl::OkStatus());
  EXPECT_EQ(received_, "012345");
  EXPECT_THAT(faulty_.uploads, ElementsAre(16U, 64U, 16U, 64U));
}

TEST_F(RemoteBackendTest, PreparationShowsProgressAndIsDoneAgainWhenCut) {
  faulty_.cut_prepare_call = 1;
  std::vector<double> shown;
  const auto prepared = backend_->PrepareTerrain(
      {}, [&](double fraction) { shown.push_back(fraction); }, {});
  ASSERT_TRUE(prepared.ok()) << prepared.status();
  EXPECT_EQ(prepared->recipe_hash(), "sha256:p");
  EXPECT_THAT(shown, ElementsAre(0.25, 0.25, 0.5));
}

TEST_F(RemoteBackendTest, PreparationWithoutResultIsAnError) {
  faulty_.ends_without_result = true;
  EXPECT_EQ(backend_->PrepareTerrain({}, {}, {}).status().code(),
            absl::StatusCode::kDataLoss);
}

TEST_F(RemoteBackendTest, RasterOfSomeoneElseIsNotFound) {
  faulty_.kept_raster = false;
  EXPECT_EQ(Stream().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(faulty_.uploads, testing::IsEmpty());
}

TEST_F(RemoteBackendTest, ViolationsArriveFieldByField) {
  v1::BadRequest bad_request;
  for (const auto& [field, text] :
       {std::pair("recipe.roughness", "must be in (0, 1), got 1.7"),
        std::pair("level", "must be in [0, 40], got 99")}) {
    v1::FieldViolation* violation = bad_request.add_field_violations();
    violation->set_field(field);
    violation->set_description(text);
  }
  v1::ErrorStatus details;
  google::protobuf::Any* detail = details.add_details();
  detail->set_type_url("type.googleapis.com/google.rpc.BadRequest");
  detail->set_value(bad_request.SerializeAsString());
  faulty_.preset_status = {grpc::StatusCode::INVALID_ARGUMENT, "bad",
                           details.SerializeAsString()};
  const absl::Status status =
      backend_->GetPreset(v1::GetPresetRequest(), {}).status();
  EXPECT_THAT(
      core::ViolationsOf(status),
      ElementsAre(
          core::Violation{"recipe.roughness", "must be in (0, 1), got 1.7"},
          core::Violation{"level", "must be in [0, 40], got 99"}));
  EXPECT_EQ(faulty_.preset_calls, 1);
}

TEST_F(RemoteBackendTest, DetailsThatAreNoMessageLeaveCodeAndText) {
  faulty_.preset_status = {grpc::StatusCode::INVALID_ARGUMENT, "bad",
                           std::string("\xff\xff\xff", 3)};
  const absl::Status status =
      backend_->GetPreset(v1::GetPresetRequest(), {}).status();
  EXPECT_EQ(status, absl::InvalidArgumentError("bad"));
}

TEST(RemoteBackend, ServerThatIsNotThereIsGivenUpSoon) {
  RemoteBackend backend("127.0.0.1:1");
  const auto start = std::chrono::steady_clock::now();
  const absl::Status status = backend.GetServerInfo({}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), HasSubstr("127.0.0.1:1"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace terrane::client
