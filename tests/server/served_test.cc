// The real service over loopback: what only the network adds to actor_test.cc.
#include "tests/server/served.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "server/service/server.h"
#include "tests/server/fake_actor.h"
#include "tests/server/recipe_text.h"

namespace terrane::server {
namespace {

using ::testing::HasSubstr;

class ServedTest : public ::testing::Test {
 protected:
  // Every message of a stream, and its status.
  std::vector<v1::StreamTilesResponse> Stream(const std::string& json,
                                              grpc::Status* status) {
    grpc::ClientContext context;
    const auto reader = served_.terrain->StreamTiles(
        &context, FromJson<v1::StreamTilesRequest>(json));
    std::vector<v1::StreamTilesResponse> messages;
    for (v1::StreamTilesResponse message; reader->Read(&message);) {
      messages.push_back(message);
    }
    *status = reader->Finish();
    return messages;
  }
  // The details of an error, which come as grpc-status-details-bin.
  v1::ErrorStatus Details(const grpc::Status& status) {
    v1::ErrorStatus details;
    EXPECT_TRUE(details.ParseFromString(status.error_details()));
    EXPECT_EQ(details.code(), status.error_code());
    return details;
  }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 1);
  Served served_{actor_.get()};
};

// What the wire carries is what the actor makes, field by field: the message
// that is put together by hand parses as the message that Protobuf would write.
TEST_F(ServedTest, MessagesAreTheActors) {
  const std::string json = R"({"terrain": {"preset": "demo/hills"}, "level": 6,
    "tileSize": 50, "window": {"x": -20, "width": 120, "height": 70}})";
  grpc::Status status;
  const auto messages = Stream(json, &status);
  ASSERT_TRUE(status.ok()) << status.error_message();
  const auto job =
      *actor_->OpenTiles(FromJson<v1::StreamTilesRequest>(json), {});
  ASSERT_EQ(messages.size(), static_cast<std::size_t>(job->total()) + 1);
  using google::protobuf::util::MessageDifferencer;
  EXPECT_TRUE(MessageDifferencer::Equals(messages[0].header(), job->header()));
  core::TileScratch scratch;
  for (std::int64_t i = 0; i < job->total(); ++i) {
    v1::HeightTile tile;
    ASSERT_TRUE(job->MakeTile(i, {}, &scratch, &tile).ok());
    EXPECT_TRUE(MessageDifferencer::Equals(
        messages[static_cast<std::size_t>(i) + 1].tile(), tile));
  }
}

TEST_F(ServedTest, ResumedStreamGoesOnWithTheSameBytes) {
  const std::string request = R"("terrain": {"preset": "demo/hills"},
    "level": 6, "tileSize": 32, "window": {"width": 100, "height": 70})";
  grpc::Status status;
  const auto whole = Stream("{" + request + "}", &status);
  const auto rest = Stream("{" + request + ", \"firstTile\": 7}", &status);
  ASSERT_TRUE(status.ok());
  ASSERT_EQ(rest.size(), whole.size() - 7);
  for (std::size_t i = 1; i < rest.size(); ++i) {
    EXPECT_EQ(rest[i].SerializeAsString(), whole[i + 7].SerializeAsString());
  }
}

TEST_F(ServedTest, ViolationsComeAsBadRequest) {
  grpc::Status status;
  Stream(R"({"terrain": {"recipe": {"roughness": 1.7}}, "level": -1})",
         &status);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  v1::BadRequest bad_request;
  ASSERT_TRUE(bad_request.ParseFromString(Details(status).details(0).value()));
  ASSERT_EQ(bad_request.field_violations_size(), 2);
  EXPECT_EQ(bad_request.field_violations(0).field(),
            "terrain.recipe.roughness");
  EXPECT_EQ(bad_request.field_violations(1).field(), "level");
}

TEST_F(ServedTest, UnknownNamesComeAsErrorInfo) {
  grpc::Status status;
  Stream(R"({"terrain": {"preset": "no/such"}})", &status);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
  v1::ErrorInfo info;
  ASSERT_TRUE(info.ParseFromString(Details(status).details(0).value()));
  EXPECT_EQ(info.reason(), "PRESET_NOT_FOUND");
  Stream(R"({"terrain": {"recipe": {"macro": {"parts":
    [{"raster": {"rasterId": "sha256:0"}}]}}},
    "window": {"width": 1, "height": 1}})",
         &status);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
  ASSERT_TRUE(info.ParseFromString(Details(status).details(0).value()));
  EXPECT_EQ(info.reason(), "RASTER_NOT_FOUND");
  Stream(R"({"terrain": {"recipe": {"spots": {"tableId": "sha256:1"}}},
    "window": {"width": 1, "height": 1}})",
         &status);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
  ASSERT_TRUE(info.ParseFromString(Details(status).details(0).value()));
  EXPECT_EQ(info.reason(), "SPOT_TABLE_NOT_FOUND");
  EXPECT_EQ(info.metadata().at("table_id"), "sha256:1");
}

TEST_F(ServedTest, SpotTableIsUploadedInChunks) {
  grpc::ClientContext context;
  v1::UploadSpotTableResponse response;
  const auto writer = served_.spot_table->UploadSpotTable(&context, &response);
  ASSERT_TRUE(writer->Write(
      FromJson<v1::UploadSpotTableRequest>(R"({"header": {"rows": "1000"}})")));
  v1::UploadSpotTableRequest chunk;
  chunk.set_chunk(std::string(6'000, '\0'));
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(writer->Write(chunk));
  writer->WritesDone();
  ASSERT_TRUE(writer->Finish().ok());
  grpc::ClientContext get_context;
  v1::GetSpotTableRequest get;
  get.set_table_id(response.table_id());
  v1::GetSpotTableResponse kept;
  ASSERT_TRUE(served_.spot_table->GetSpotTable(&get_context, get, &kept).ok());
  EXPECT_EQ(kept.table_id(), response.table_id());
  EXPECT_EQ(kept.header().rows(), 1000);
}

TEST_F(ServedTest, RasterIsUploadedInChunks) {
  grpc::ClientContext context;
  v1::UploadRasterResponse response;
  const auto writer = served_.raster->UploadRaster(&context, &response);
  ASSERT_TRUE(writer->Write(FromJson<v1::UploadRasterRequest>(
      R"({"header": {"width": "300", "height": "200"}})")));
  v1::UploadRasterRequest chunk;
  chunk.set_chunk(std::string(60'000, '\0'));
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(writer->Write(chunk));
  writer->WritesDone();
  ASSERT_TRUE(writer->Finish().ok());
  grpc::ClientContext get_context;
  v1::GetRasterRequest get;
  get.set_raster_id(response.raster_id());
  v1::GetRasterResponse kept;
  ASSERT_TRUE(served_.raster->GetRaster(&get_context, get, &kept).ok());
  EXPECT_EQ(kept.header().width(), 300);
}

// A raster as large as the store: it fits only when what came before it has
// been given up.
TEST(ServedUploadTest, TruncatedAndCancelledUploadsLeaveNothing) {
  Limits limits;
  limits.raster_store_bytes = 240'000;
  const auto actor = MakeActor(limits, 1);
  Served served(actor.get());
  const auto upload = [&](int bytes, bool cancel) {
    grpc::ClientContext context;
    v1::UploadRasterResponse response;
    const auto writer = served.raster->UploadRaster(&context, &response);
    writer->Write(FromJson<v1::UploadRasterRequest>(
        R"({"header": {"width": "300", "height": "200"}})"));
    v1::UploadRasterRequest chunk;
    chunk.set_chunk(std::string(static_cast<std::size_t>(bytes), '\0'));
    writer->Write(chunk);
    if (cancel) {
      context.TryCancel();
    } else {
      writer->WritesDone();
    }
    return writer->Finish();
  };
  const grpc::Status truncated = upload(1000, false);
  EXPECT_EQ(truncated.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(truncated.error_message(),
            "chunk: must hold 240000 bytes in all, got 1000");
  EXPECT_EQ(upload(1000, true).error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(Eventually([&] { return upload(240'000, false).ok(); }));
}

TEST_F(ServedTest, LargeMessagesAreRefused) {
  grpc::ClientContext context;
  v1::GetPresetRequest request;
  request.set_name(std::string(5 << 20, 'x'));
  v1::GetPresetResponse response;
  EXPECT_EQ(
      served_.terrain->GetPreset(&context, request, &response).error_code(),
      grpc::StatusCode::RESOURCE_EXHAUSTED);
}

TEST_F(ServedTest, CompressedRequestsAreRefused) {
  grpc::ClientContext context;
  context.set_compression_algorithm(GRPC_COMPRESS_GZIP);
  v1::GetPresetRequest request;
  request.set_name(std::string(100'000, 'x'));
  v1::GetPresetResponse response;
  EXPECT_EQ(
      served_.terrain->GetPreset(&context, request, &response).error_code(),
      grpc::StatusCode::UNIMPLEMENTED);
}

TEST_F(ServedTest, LogHasOneLinePerCall) {
  grpc::Status status;
  Stream(R"({"terrain": {"preset": "demo/hills"}, "tileSize": 16,
    "window": {"width": 32, "height": 32}})",
         &status);
  EXPECT_THAT(
      served_.StopAndReadLog(),
      ::testing::ContainsRegex(
          "^.\"time\":\"[^\"]*\",\"level\":\"info\",\"event\":\"call\","
          "\"request_id\":\"[0-9a-f]*\",\"method\":\"StreamTiles\","
          "\"code\":\"OK\",\"total_ms\":[0-9.]*,\"queue_ms\":[0-9.]*,"
          "\"generate_ms\":[0-9.]*,\"send_ms\":[0-9.]*,"
          "\"estimate_ms\":[0-9.]*,"
          "\"recipe\":\"sha256:[0-9a-f]*\",\"tiles\":4,\"samples\":1024,"
          "\"bytes\":4096.\n$"));
}

}  // namespace
}  // namespace terrane::server
