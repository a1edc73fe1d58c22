// The backend without a server: a stop reaches whatever takes long.
#include "client/local_backend.h"

#include <gtest/gtest.h>

#include <stop_token>

namespace terrane::client {
namespace {

// A flower is made before its header is known.
TEST(LocalBackend, AFlowerThatIsStoppedInTheMakingHasNoHeader) {
  std::stop_source stop;
  stop.request_stop();
  v1::StreamFlowerRequest request;
  request.mutable_flower()->set_preset("flower/tulip");
  bool has_header = false;
  const absl::Status status = LocalBackend(1).flowers().StreamFlower(
      request,
      [&](const v1::FlowerHeader&) {
        has_header = true;
        return absl::OkStatus();
      },
      [](const v1::StreamFlowerResponse&) { return absl::OkStatus(); },
      stop.get_token());
  EXPECT_TRUE(absl::IsCancelled(status)) << status.ToString();
  EXPECT_FALSE(has_header);
}

}  // namespace
}  // namespace terrane::client
