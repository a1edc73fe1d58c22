// Pictures over loopback: what only the network adds to render_actor_test.cc.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/server/recipe_text.h"
#include "tests/server/served.h"

namespace terrane::server {
namespace {

class ServedRenderTest : public ::testing::Test {
 protected:
  static v1::StreamRenderRequest Asked(int passes) {
    auto request = FromJson<v1::StreamRenderRequest>(
        R"({"surface": {"surface": {"preset": "surface/fig07"},
            "columns": "33", "rows": "33"}, "width": 60, "height": 40})");
    request.set_passes(passes);
    return request;
  }

  const std::unique_ptr<Actor> actor_ = MakeActor({}, 2);
  Served served_{actor_.get()};
};

TEST_F(ServedRenderTest, StreamsAreThoseOfTheActor) {
  grpc::ClientContext context;
  const auto reader = served_.render->StreamRender(&context, Asked(4));
  const auto run = actor_->renders().Open(Asked(4), {});
  ASSERT_TRUE(run.ok());
  v1::StreamRenderResponse expected;
  for (v1::StreamRenderResponse message; reader->Read(&message);) {
    ASSERT_TRUE((*run)->Next({}, &expected).ok());
    EXPECT_EQ(message.SerializeAsString(), expected.SerializeAsString());
  }
  EXPECT_TRUE((*run)->Done());
  EXPECT_TRUE(reader->Finish().ok());
}

TEST_F(ServedRenderTest, CancellingEndsIt) {
  grpc::ClientContext context;
  const auto reader = served_.render->StreamRender(&context, Asked(4096));
  v1::StreamRenderResponse message;
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(reader->Read(&message));
  context.TryCancel();
  while (reader->Read(&message)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

TEST_F(ServedRenderTest, EstimatesAreServed) {
  grpc::ClientContext context;
  v1::EstimateRenderRequest request;
  *request.mutable_request() = Asked(4);
  v1::EstimateRenderResponse estimate;
  ASSERT_TRUE(
      served_.render->EstimateRender(&context, request, &estimate).ok());
  EXPECT_EQ(estimate.paths(), 4 * 60 * 40);
}

}  // namespace
}  // namespace terrane::server
