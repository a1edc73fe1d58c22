// absl::Status to grpc::Status: codes, cut messages, and details that a
// standard client decodes.
#include "server/service/status.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/violations.h"
#include "server/actor/error_reason.h"
#include "terrane/v1/common.pb.h"

namespace terrane::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

v1::ErrorStatus DetailsOf(const grpc::Status& status) {
  v1::ErrorStatus details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  return details;
}

TEST(StatusTest, EveryCodeIsMapped) {
  EXPECT_TRUE(ToGrpcStatus(absl::OkStatus(), "id").ok());
  for (int code = 1; code <= 16; ++code) {
    const absl::Status status(static_cast<absl::StatusCode>(code), "text");
    const grpc::Status mapped = ToGrpcStatus(status, "id");
    switch (status.code()) {
      case absl::StatusCode::kUnknown:
        EXPECT_EQ(mapped.error_code(), grpc::StatusCode::INTERNAL);
        break;
      case absl::StatusCode::kOutOfRange:
        EXPECT_EQ(mapped.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
        break;
      default:
        EXPECT_EQ(static_cast<int>(mapped.error_code()), code);
    }
  }
}

TEST(StatusTest, ServerFaultsShowOnlyAnId) {
  const grpc::Status status =
      ToGrpcStatus(absl::InternalError("cannot read /etc/secret"), "abc-1");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INTERNAL);
  EXPECT_EQ(status.error_message(), "internal error, request id abc-1");
  EXPECT_EQ(status.error_details(), "");
}

TEST(StatusTest, LongMessagesAreCutBetweenCharacters) {
  std::string text;
  while (text.size() < 2 * kMaxMessageBytes) text += "\u00fc\u6c34";
  const grpc::Status status = ToGrpcStatus(absl::UnavailableError(text), "id");
  const std::string cut = status.error_message();
  EXPECT_LE(cut.size(), kMaxMessageBytes);
  EXPECT_GT(cut.size(), kMaxMessageBytes - 8);
  ASSERT_TRUE(cut.ends_with("..."));
  const std::string kept = cut.substr(0, cut.size() - 3);
  // A whole number of characters: what is left of the text starts a new one.
  EXPECT_NE(static_cast<unsigned char>(text[kept.size()]) & 0xC0, 0x80);
  EXPECT_EQ(text.substr(0, kept.size()), kept);
}

TEST(StatusTest, ViolationsBecomeBadRequest) {
  core::Violations violations;
  violations.Add("recipe.roughness", "must be in (0, 1), got 1.7");
  violations.Add("level", "must be in [0, 40], got 41");
  const grpc::Status status = ToGrpcStatus(violations.ToStatus(), "id");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  const v1::ErrorStatus details = DetailsOf(status);
  EXPECT_EQ(details.code(), 3);
  EXPECT_EQ(details.message(), status.error_message());
  ASSERT_EQ(details.details_size(), 1);
  EXPECT_EQ(details.details(0).type_url(),
            "type.googleapis.com/google.rpc.BadRequest");
  v1::BadRequest bad_request;
  ASSERT_TRUE(bad_request.ParseFromString(details.details(0).value()));
  ASSERT_EQ(bad_request.field_violations_size(), 2);
  EXPECT_EQ(bad_request.field_violations(0).field(), "recipe.roughness");
  EXPECT_EQ(bad_request.field_violations(0).description(),
            "must be in (0, 1), got 1.7");
  EXPECT_EQ(bad_request.field_violations(1).field(), "level");
}

TEST(StatusTest, DetailsFitIntoMetadata) {
  core::Violations violations;
  for (int i = 0; i < 1000; ++i) {
    violations.Add("field" + std::to_string(i), std::string(5000, 'x'));
  }
  const grpc::Status status = ToGrpcStatus(violations.ToStatus(), "id");
  EXPECT_LE(status.error_details().size(), kMaxDetailBytes);
  v1::BadRequest bad_request;
  ASSERT_TRUE(
      bad_request.ParseFromString(DetailsOf(status).details(0).value()));
  const int kept = bad_request.field_violations_size();
  ASSERT_GE(kept, 2);
  EXPECT_EQ(bad_request.field_violations(0).field(), "field0");
  EXPECT_EQ(bad_request.field_violations(kept - 1).field(), "(more)");
}

TEST(StatusTest, ReasonsBecomeErrorInfo) {
  const grpc::Status status = ToGrpcStatus(
      NotFoundError("gone", {"RASTER_NOT_FOUND", "raster_id", "sha256:1\0x"}),
      "id");
  const v1::ErrorStatus details = DetailsOf(status);
  ASSERT_EQ(details.details_size(), 1);
  EXPECT_EQ(details.details(0).type_url(),
            "type.googleapis.com/google.rpc.ErrorInfo");
  v1::ErrorInfo info;
  ASSERT_TRUE(info.ParseFromString(details.details(0).value()));
  EXPECT_EQ(info.reason(), "RASTER_NOT_FOUND");
  EXPECT_EQ(info.domain(), "terrane");
  EXPECT_EQ(info.metadata().at("raster_id"), "sha256:1");
}

TEST(StatusTest, RefusalsSayWhenToComeBack) {
  const grpc::Status status = ToGrpcStatus(
      RetryLaterError("busy", std::chrono::milliseconds(1500)), "id");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  const v1::ErrorStatus details = DetailsOf(status);
  ASSERT_EQ(details.details_size(), 1);
  EXPECT_EQ(details.details(0).type_url(),
            "type.googleapis.com/google.rpc.RetryInfo");
  v1::RetryInfo retry;
  ASSERT_TRUE(retry.ParseFromString(details.details(0).value()));
  EXPECT_EQ(retry.retry_delay().seconds(), 1);
  EXPECT_EQ(retry.retry_delay().nanos(), 500'000'000);
}

}  // namespace
}  // namespace terrane::server
