// What a status and its trailing metadata ask the client to do.
#include "client/status_details.h"

#include <gtest/gtest.h>

#include "tests/client/faulty_server.h"

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

const grpc::Status kBusy(grpc::StatusCode::RESOURCE_EXHAUSTED, "busy");

RemoteError WithPushback(const std::string& text,
                         const grpc::Status& status = kBusy) {
  return DecodeStatus(status, {{"grpc-retry-pushback-ms", text}});
}

TEST(DecodeStatus, RetryInfoSaysHowLongToWait) {
  const RemoteError error = DecodeStatus(ComeBackAfter(milliseconds(2'345)));
  EXPECT_EQ(error.status, absl::ResourceExhaustedError("busy"));
  EXPECT_EQ(error.retry_delay, milliseconds(2'345));
  EXPECT_FALSE(error.turned_away);
}

TEST(DecodeStatus, SoDoesTheMetadataOfAProxy) {
  EXPECT_EQ(WithPushback("700").retry_delay, milliseconds(700));
  EXPECT_EQ(WithPushback("0").retry_delay, milliseconds(0));
  EXPECT_EQ(DecodeStatus(kBusy, {{"other", "700"}}).retry_delay, std::nullopt);
  EXPECT_EQ(DecodeStatus(kBusy).retry_delay, std::nullopt);
}

TEST(DecodeStatus, RetryInfoGoesBeforeTheMetadata) {
  const RemoteError error = WithPushback("1", ComeBackAfter(milliseconds(900)));
  EXPECT_EQ(error.retry_delay, milliseconds(900));
  EXPECT_FALSE(
      WithPushback("-1", ComeBackAfter(milliseconds(900))).turned_away);
}

TEST(DecodeStatus, MetadataWithoutATimeTurnAway) {
  for (const char* text :
       {"-1", "", "soon", "10s", " 10", "99999999999999999999"}) {
    const RemoteError error = WithPushback(text);
    EXPECT_TRUE(error.turned_away) << text;
    EXPECT_EQ(error.retry_delay, std::nullopt) << text;
  }
}

TEST(DecodeStatus, NoTimeIsNegativeOrWithoutEnd) {
  v1::RetryInfo retry;
  retry.mutable_retry_delay()->set_nanos(-2'000'000'000);
  const grpc::Status odd(grpc::StatusCode::RESOURCE_EXHAUSTED, "busy",
                         Details("RetryInfo", retry));
  EXPECT_EQ(DecodeStatus(odd).retry_delay, milliseconds(0));
  EXPECT_EQ(WithPushback("9000000000000000000").retry_delay,
            std::chrono::hours(1));
}

TEST(DecodeStatus, SuccessAsksForNothing) {
  const RemoteError error = WithPushback("-1", grpc::Status::OK);
  EXPECT_EQ(error.status, absl::OkStatus());
  EXPECT_FALSE(error.turned_away);
}

}  // namespace
}  // namespace terrane::client
