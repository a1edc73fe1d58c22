// Surfaces over loopback: what only the network adds to surface_actor_test.cc.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/server/recipe_text.h"
#include "tests/server/served.h"

namespace terrane::server {
namespace {

class ServedSurfaceTest : public ::testing::Test {
 protected:
  std::vector<v1::StreamSurfaceResponse> Stream(const std::string& json,
                                                grpc::Status* status) {
    grpc::ClientContext context;
    const auto reader = served_.surface->StreamSurface(
        &context, FromJson<v1::StreamSurfaceRequest>(json));
    std::vector<v1::StreamSurfaceResponse> messages;
    for (v1::StreamSurfaceResponse message; reader->Read(&message);) {
      messages.push_back(message);
    }
    *status = reader->Finish();
    return messages;
  }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 1);
  Served served_{actor_.get()};
};

TEST_F(ServedSurfaceTest, StreamsTheHeaderAndEveryTileInOrder) {
  grpc::Status status;
  const auto messages = Stream(
      R"({"surface": {"preset": "surface/fig08"}, "columns": 90, "rows": 70,
          "tileSize": 32})",
      &status);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(messages.size(), 10u);
  EXPECT_TRUE(messages[0].has_header());
  for (std::size_t k = 1; k < messages.size(); ++k) {
    EXPECT_EQ(messages[k].mesh_tile().index(),
              static_cast<std::int64_t>(k) - 1);
  }
  // Resumed in the middle: the same messages from there on.
  const auto rest = Stream(
      R"({"surface": {"preset": "surface/fig08"}, "columns": 90, "rows": 70,
          "tileSize": 32, "firstTile": 4})",
      &status);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(rest.size(), 6u);
  for (std::size_t k = 1; k < rest.size(); ++k) {
    EXPECT_EQ(rest[k].SerializeAsString(), messages[k + 4].SerializeAsString());
  }
}

TEST_F(ServedSurfaceTest, ErrorsAreInvalidArgumentWithDetails) {
  grpc::Status status;
  EXPECT_TRUE(
      Stream(R"({"surface": {"preset": "surface/fig02"}})", &status).empty());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  v1::ErrorStatus details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.details_size(), 1);
}

TEST_F(ServedSurfaceTest, PresetsAndEstimatesAreServed) {
  grpc::ClientContext preset_context;
  v1::GetSurfacePresetRequest ask;
  ask.set_name("surface/fig13");
  v1::GetSurfacePresetResponse preset;
  ASSERT_TRUE(
      served_.surface->GetSurfacePreset(&preset_context, ask, &preset).ok());
  EXPECT_EQ(preset.preset().name(), "surface/fig13");
  grpc::ClientContext estimate_context;
  v1::EstimateSurfaceRequest price;
  *price.mutable_request()->mutable_surface()->mutable_recipe() =
      preset.preset().recipe();
  price.mutable_request()->set_columns(100);
  price.mutable_request()->set_rows(100);
  v1::EstimateSurfaceResponse estimate;
  ASSERT_TRUE(
      served_.surface->EstimateSurface(&estimate_context, price, &estimate)
          .ok());
  EXPECT_EQ(estimate.samples(), 10'000);
}

}  // namespace
}  // namespace terrane::server
