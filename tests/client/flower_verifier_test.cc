// What the verifier of flowers finds wrong, over real parts with one fault
// each; and the model that is made of them.
#include "client/flower_verifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/flower_model.h"
#include "client/local_backend.h"

namespace terrane::client {
namespace {

using ::testing::HasSubstr;

class FlowerVerifierTest : public ::testing::Test {
 protected:
  void SetUp() override {
    choice_.set_preset("flower/tulip");
    choice_.set_plants(3);
    v1::StreamFlowerRequest request;
    *request.mutable_flower() = choice_;
    ASSERT_TRUE(backend_.flowers()
                    .StreamFlower(
                        request,
                        [this](const v1::FlowerHeader& header) {
                          header_ = header;
                          return absl::OkStatus();
                        },
                        [this](const v1::StreamFlowerResponse& part) {
                          parts_.push_back(part);
                          return absl::OkStatus();
                        },
                        {})
                    .ok());
  }

  // What the verifier says of `part` in place of the one at `index`.
  std::string Fault(std::size_t index, const v1::StreamFlowerResponse& part) {
    FlowerVerifier verifier{v1::StreamFlowerRequest()};
    EXPECT_TRUE(verifier.CheckHeader(header_).ok());
    for (std::size_t k = 0; k < index; ++k) {
      EXPECT_TRUE(verifier.CheckTile(parts_[k]).ok());
    }
    const absl::Status status = verifier.CheckTile(part);
    EXPECT_EQ(verifier.next_index(),
              static_cast<std::int64_t>(index + (status.ok() ? 1 : 0)));
    return std::string(status.message());
  }

  LocalBackend backend_{1};
  v1::FlowerChoice choice_;
  v1::FlowerHeader header_;
  std::vector<v1::StreamFlowerResponse> parts_;
};

TEST_F(FlowerVerifierTest, WrongPartsAreNamed) {
  EXPECT_EQ(Fault(0, parts_[0]), "");
  EXPECT_THAT(Fault(0, parts_[1]), HasSubstr("came where 0 belongs"));
  v1::StreamFlowerResponse part = parts_[0];
  (*part.mutable_prototype()->mutable_normals())[7] ^= 1;
  EXPECT_THAT(Fault(0, part), HasSubstr("checksum"));
  part = parts_[0];
  part.mutable_prototype()->mutable_uvs()->pop_back();
  EXPECT_THAT(Fault(0, part), HasSubstr("bytes of texture coordinates"));
  part = parts_[0];
  part.mutable_prototype()->set_prototype(1000);
  EXPECT_THAT(Fault(0, part), HasSubstr("is of prototype 1000"));
  const std::size_t last = parts_.size() - 1;
  ASSERT_TRUE(parts_[last].has_instances());
  part = parts_[last];
  part.mutable_instances()->mutable_organs()->push_back('\1');
  EXPECT_THAT(Fault(last, part), HasSubstr("bytes of organs"));
}

TEST_F(FlowerVerifierTest, AStreamMustBeWholeAndOfOneFlower) {
  FlowerVerifier verifier{v1::StreamFlowerRequest()};
  EXPECT_TRUE(absl::IsDataLoss(verifier.CheckEnd()));
  ASSERT_TRUE(verifier.CheckHeader(header_).ok());
  EXPECT_THAT(std::string(verifier.CheckEnd().message()),
              HasSubstr("ended after 0 of"));
  v1::FlowerHeader other = header_;
  other.set_revision(other.revision() + 1);
  EXPECT_TRUE(absl::IsFailedPrecondition(verifier.CheckHeader(other)));
}

TEST_F(FlowerVerifierTest, TheModelHoldsEveryInstanceOnce) {
  const absl::StatusOr<FlowerModel> model = FlowerModel::Stream(
      choice_, ProgressMode::kNone, &backend_.flowers(), {});
  ASSERT_TRUE(model.ok()) << model.status();
  const core::Scene scene = model->View();
  std::int64_t instances = 0;
  for (const core::SceneObject& object : scene.objects) {
    instances += static_cast<std::int64_t>(object.instances->count());
    EXPECT_EQ(object.mesh->normals.size(), object.mesh->positions.size());
    EXPECT_LT(object.material, scene.materials.size());
  }
  EXPECT_EQ(instances, header_.rows());
  EXPECT_EQ(model->header().recipe().bed().plants(), 3);
}

}  // namespace
}  // namespace terrane::client
