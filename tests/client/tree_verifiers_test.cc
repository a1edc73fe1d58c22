// What the verifiers of trees find wrong, over real blocks with one fault each.
#include "client/tree_verifiers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "client/local_backend.h"

namespace terrane::client {
namespace {

using ::testing::HasSubstr;

class TreeVerifiersTest : public ::testing::Test {
 protected:
  void SetUp() override {
    choice_.mutable_recipe()->set_dimensions(3);
    choice_.mutable_recipe()->mutable_leaves();
    choice_.set_depth(6);
    v1::StreamTreeRequest rows;
    *rows.mutable_tree() = choice_;
    ASSERT_TRUE(backend_.trees()
                    .StreamTree(
                        rows,
                        [this](const v1::TreeHeader& header) {
                          header_ = header;
                          return absl::OkStatus();
                        },
                        [this](const v1::SegmentRows& block) {
                          rows_.push_back(block);
                          return absl::OkStatus();
                        },
                        {})
                    .ok());
    ASSERT_GE(rows_.size(), 2u);
  }

  // What CheckTile says of the second block once `fault` was put into it.
  std::string Fault(const std::function<void(v1::SegmentRows*)>& fault) {
    TreeRowsVerifier verifier{v1::StreamTreeRequest()};
    EXPECT_TRUE(verifier.CheckHeader(header_).ok());
    EXPECT_TRUE(verifier.CheckTile(rows_[0]).ok());
    v1::SegmentRows block = rows_[1];
    fault(&block);
    const absl::Status status = verifier.CheckTile(block);
    if (!status.ok()) {
      EXPECT_TRUE(absl::IsDataLoss(status));
      EXPECT_EQ(verifier.next_index(), rows_[0].rows());
    }
    return std::string(status.message());
  }

  LocalBackend backend_{1};
  v1::TreeChoice choice_;
  v1::TreeHeader header_;
  std::vector<v1::SegmentRows> rows_;
};

TEST_F(TreeVerifiersTest, GoodRowsPass) {
  EXPECT_EQ(Fault([](v1::SegmentRows*) {}), "");
}

TEST_F(TreeVerifiersTest, WrongRowsAreNamed) {
  EXPECT_THAT(Fault([](v1::SegmentRows* block) {
                block->set_first_row(block->first_row() + 1);
              }),
              HasSubstr("came where 256 belongs"));
  EXPECT_THAT(
      Fault([](v1::SegmentRows* block) { block->mutable_ends()->pop_back(); }),
      HasSubstr("bytes of ends"));
  EXPECT_THAT(Fault([](v1::SegmentRows* block) {
                (*block->mutable_radius_ends())[5] ^= 1;
              }),
              HasSubstr("checksum"));
  EXPECT_THAT(Fault([](v1::SegmentRows* block) { block->clear_extensions(); }),
              HasSubstr("bytes of extensions"));
}

TEST_F(TreeVerifiersTest, AnotherTreeCannotGoOn) {
  TreeRowsVerifier verifier{v1::StreamTreeRequest()};
  EXPECT_TRUE(absl::IsDataLoss(verifier.CheckEnd()));
  ASSERT_TRUE(verifier.CheckHeader(header_).ok());
  v1::TreeHeader other = header_;
  other.set_recipe_hash("sha256:other");
  EXPECT_TRUE(absl::IsFailedPrecondition(verifier.CheckHeader(other)));
}

TEST_F(TreeVerifiersTest, AForestThatIsCutHandsNoBlockOutTwice) {
  v1::StreamForestRequest request;
  *request.mutable_tree() = choice_;
  request.mutable_seeds()->set_count(2);
  request.set_leaves(true);
  std::vector<v1::ForestBlock> blocks;
  ASSERT_TRUE(backend_.trees()
                  .StreamForest(
                      request,
                      [](const v1::TreeHeader&) { return absl::OkStatus(); },
                      [&](const v1::ForestBlock& block) {
                        blocks.push_back(block);
                        return absl::OkStatus();
                      },
                      {})
                  .ok());
  ASSERT_GE(blocks.size(), 4u);
  ASSERT_FALSE(blocks[0].ends_tree());
  ForestVerifier verifier(request);
  ASSERT_TRUE(verifier.CheckHeader(header_).ok());
  EXPECT_TRUE(verifier.CheckTile(blocks[0]).ok());
  EXPECT_TRUE(verifier.CheckTile(blocks[1]).ok());
  EXPECT_FALSE(verifier.IsRepeat());
  EXPECT_TRUE(absl::IsDataLoss(verifier.CheckEnd()));
  // Cut here; the server begins the tree again.
  ASSERT_TRUE(verifier.CheckHeader(header_).ok());
  std::vector<bool> repeats;
  for (const v1::ForestBlock& block : blocks) {
    ASSERT_TRUE(verifier.CheckTile(block).ok());
    repeats.push_back(verifier.IsRepeat());
  }
  std::vector<bool> expected(blocks.size(), false);
  expected[0] = expected[1] = true;
  EXPECT_EQ(repeats, expected);
  EXPECT_TRUE(verifier.CheckEnd().ok());
}

TEST_F(TreeVerifiersTest, TubesWithAWildTriangleAreRefused) {
  v1::StreamTreeMeshRequest request;
  *request.mutable_tree() = choice_;
  std::vector<v1::TubeBlock> blocks;
  ASSERT_TRUE(backend_.trees()
                  .StreamTreeMesh(
                      request,
                      [](const v1::TreeHeader&) { return absl::OkStatus(); },
                      [&](const v1::TubeBlock& block) {
                        blocks.push_back(block);
                        return absl::OkStatus();
                      },
                      {})
                  .ok());
  TubesVerifier verifier(request);
  ASSERT_TRUE(verifier.CheckHeader(header_).ok());
  v1::TubeBlock damaged = blocks[0];
  damaged.mutable_indices()->pop_back();
  EXPECT_THAT(std::string(verifier.CheckTile(damaged).message()),
              HasSubstr("a part of a triangle"));
  EXPECT_TRUE(verifier.CheckTile(blocks[0]).ok());
}

}  // namespace
}  // namespace terrane::client
