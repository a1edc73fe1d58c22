// Trees over loopback: what only the network adds to tree_actor_test.cc.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/server/recipe_text.h"
#include "tests/server/served.h"
#include "tests/server/tree_runs.h"

namespace terrane::server {
namespace {

class ServedTreeTest : public ::testing::Test {
 protected:
  const std::unique_ptr<Actor> actor_ = MakeActor({}, 2);
  Served served_{actor_.get()};
};

TEST_F(ServedTreeTest, StreamsAreThoseOfTheActor) {
  const auto request = FromJson<v1::StreamTreeRequest>(
      R"({"tree": {"recipe": {"seed": "9", "dimensions": 3}}})");
  grpc::ClientContext context;
  const auto reader = served_.tree->StreamTree(&context, request);
  std::vector<std::string> messages;
  for (v1::StreamTreeResponse message; reader->Read(&message);) {
    messages.push_back(message.SerializeAsString());
  }
  ASSERT_TRUE(reader->Finish().ok());
  const auto expected = ReadAll(actor_->trees().OpenRows(request));
  ASSERT_EQ(messages.size(), expected.size());
  for (std::size_t k = 0; k < messages.size(); ++k) {
    EXPECT_EQ(messages[k], expected[k].SerializeAsString());
  }
}

TEST_F(ServedTreeTest, CancellingIsALevelOfDetail) {
  grpc::ClientContext context;
  const auto reader = served_.tree->StreamTree(
      &context, FromJson<v1::StreamTreeRequest>(
                    R"({"tree": {"recipe": {"depth": 11,
                        "lengthMode": "LENGTH_MODE_RELATIVE"}}})"));
  v1::StreamTreeResponse message;
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(reader->Read(&message));
  context.TryCancel();
  while (reader->Read(&message)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

TEST_F(ServedTreeTest, EveryCallIsServed) {
  const auto choice =
      FromJson<v1::TreeChoice>(R"({"recipe": {"depth": 3, "leaves": {}}})");
  {
    grpc::ClientContext context;
    v1::StreamTreeLeavesRequest request;
    *request.mutable_tree() = choice;
    const auto reader = served_.tree->StreamTreeLeaves(&context, request);
    v1::StreamTreeLeavesResponse message;
    ASSERT_TRUE(reader->Read(&message));
    EXPECT_TRUE(message.has_header());
    ASSERT_TRUE(reader->Read(&message));
    EXPECT_GT(message.leaves().leaves(), 0);
    EXPECT_TRUE(reader->Finish().ok());
  }
  {
    grpc::ClientContext context;
    v1::StreamTreeMeshRequest request;
    *request.mutable_tree() = choice;
    const auto reader = served_.tree->StreamTreeMesh(&context, request);
    v1::StreamTreeMeshResponse message;
    ASSERT_TRUE(reader->Read(&message));
    ASSERT_TRUE(reader->Read(&message));
    EXPECT_GT(message.block().vertices(), 0);
    EXPECT_TRUE(reader->Finish().ok());
  }
  {
    grpc::ClientContext context;
    v1::StreamForestRequest request;
    *request.mutable_tree() = choice;
    request.mutable_seeds()->set_count(4);
    const auto reader = served_.tree->StreamForest(&context, request);
    v1::StreamForestResponse message;
    int messages = 0;
    while (reader->Read(&message)) ++messages;
    EXPECT_EQ(messages, 5);
    EXPECT_TRUE(message.block().ends_tree());
    EXPECT_TRUE(reader->Finish().ok());
  }
  {
    grpc::ClientContext context;
    v1::EstimateTreeRequest request;
    *request.mutable_tree() = choice;
    v1::EstimateTreeResponse estimate;
    ASSERT_TRUE(served_.tree->EstimateTree(&context, request, &estimate).ok());
    EXPECT_EQ(estimate.last_generation(), 3);
  }
}

TEST_F(ServedTreeTest, ErrorsCarryTheirFields) {
  grpc::ClientContext context;
  const auto reader =
      served_.tree->StreamTree(&context, v1::StreamTreeRequest());
  v1::StreamTreeResponse message;
  EXPECT_FALSE(reader->Read(&message));
  const grpc::Status status = reader->Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  v1::ErrorStatus details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.details_size(), 1);
}

}  // namespace
}  // namespace terrane::server
