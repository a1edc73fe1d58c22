// What the verifier of pictures finds wrong, over real bands with one fault
// each.
#include "client/render_verifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "client/local_backend.h"

namespace terrane::client {
namespace {

using ::testing::HasSubstr;

class RenderVerifierTest : public ::testing::Test {
 protected:
  void SetUp() override {
    v1::SurfaceSubject* const subject = request_.mutable_surface();
    subject->mutable_surface()->set_preset("surface/fig07");
    subject->set_columns(17);
    subject->set_rows(17);
    request_.set_width(64);
    request_.set_height(48);
    request_.set_passes(3);
    ASSERT_TRUE(backend_.renders()
                    .StreamRender(
                        request_,
                        [this](const v1::RenderHeader& header) {
                          header_ = header;
                          return absl::OkStatus();
                        },
                        [this](const v1::StreamRenderResponse& part) {
                          if (part.has_band()) parts_.push_back(part);
                          return absl::OkStatus();
                        },
                        {})
                    .ok());
    ASSERT_EQ(parts_.size(), 3u);
  }

  // What the verifier says of the first band after a change.
  absl::Status Checked(const std::function<void(v1::RenderBand*)>& change) {
    RenderVerifier verifier(request_);
    EXPECT_TRUE(verifier.CheckHeader(header_).ok());
    v1::StreamRenderResponse part = parts_.front();
    change(part.mutable_band());
    return verifier.CheckTile(part);
  }

  LocalBackend backend_{1};
  v1::StreamRenderRequest request_;
  v1::RenderHeader header_;
  std::vector<v1::StreamRenderResponse> parts_;
};

TEST_F(RenderVerifierTest, GoodBandsPass) {
  RenderVerifier verifier(request_);
  EXPECT_TRUE(absl::IsDataLoss(verifier.CheckEnd()));
  EXPECT_TRUE(absl::IsDataLoss(verifier.CheckTile(parts_.front())));
  EXPECT_TRUE(verifier.CheckHeader(header_).ok());
  for (const v1::StreamRenderResponse& part : parts_) {
    EXPECT_TRUE(absl::IsDataLoss(verifier.CheckEnd()));
    EXPECT_TRUE(verifier.CheckTile(part).ok());
  }
  EXPECT_TRUE(verifier.CheckEnd().ok());
  EXPECT_EQ(verifier.next_index(), 3);
}

TEST_F(RenderVerifierTest, OneFaultEachIsFound) {
  const auto says = [&](const std::function<void(v1::RenderBand*)>& change) {
    const absl::Status status = Checked(change);
    EXPECT_TRUE(absl::IsDataLoss(status)) << status;
    return std::string(status.message());
  };
  EXPECT_TRUE(Checked([](v1::RenderBand*) {}).ok());
  EXPECT_THAT(says([](v1::RenderBand* band) { band->set_index(1); }),
              HasSubstr("came where 0"));
  EXPECT_THAT(says([](v1::RenderBand* band) { band->set_first_row(1); }),
              HasSubstr("other rows"));
  EXPECT_THAT(says([](v1::RenderBand* band) { band->set_rows(47); }),
              HasSubstr("other rows"));
  EXPECT_THAT(
      says([](v1::RenderBand* band) { band->mutable_pixels()->pop_back(); }),
      HasSubstr("expected 9216"));
  EXPECT_THAT(
      says([](v1::RenderBand* band) { (*band->mutable_pixels())[7] ^= 1; }),
      HasSubstr("checksum"));
}

TEST_F(RenderVerifierTest, AResumedStreamMustBeTheSamePicture) {
  RenderVerifier verifier(request_);
  ASSERT_TRUE(verifier.CheckHeader(header_).ok());
  ASSERT_TRUE(verifier.CheckTile(parts_.front()).ok());
  EXPECT_TRUE(verifier.CheckHeader(header_).ok());
  EXPECT_EQ(verifier.next_index(), 1);
  header_.set_recipe_hash("sha256:another");
  EXPECT_TRUE(absl::IsFailedPrecondition(verifier.CheckHeader(header_)));
}

}  // namespace
}  // namespace terrane::client
