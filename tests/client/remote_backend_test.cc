// RemoteBackend against a server that misbehaves on purpose.
#include "client/remote_backend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/base/violations.h"
#include "tests/client/faulty_server.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;

class RemoteBackendTest : public testing::Test {
 protected:
  void SetUp() override {
    int port = 0;
    server_ = Serve(&faulty_, &port);
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
  faulty_.preset_status = {grpc::StatusCode::INVALID_ARGUMENT, "bad",
                           Details("BadRequest", bad_request)};
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

}  // namespace
}  // namespace terrane::client
