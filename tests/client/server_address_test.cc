// --server as text: one server, replicas, a name with several addresses.
#include "client/server_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace terrane::client {
namespace {

using testing::HasSubstr;

void ExpectAddress(const std::string& text, const std::string& target,
                   bool several, bool loopback) {
  const absl::StatusOr<ServerAddress> address = ParseServerAddress(text);
  ASSERT_TRUE(address.ok()) << text << ": " << address.status();
  EXPECT_EQ(address->target, target);
  EXPECT_EQ(address->several, several) << text;
  EXPECT_EQ(address->loopback, loopback) << text;
}

TEST(ServerAddress, OneServerIsDialledAsItIsWritten) {
  ExpectAddress("127.0.0.1:50051", "127.0.0.1:50051", false, true);
  ExpectAddress("localhost:7400", "localhost:7400", false, true);
  ExpectAddress("[::1]:7400", "[::1]:7400", false, true);
  ExpectAddress("terrane.example:443", "terrane.example:443", false, false);
}

TEST(ServerAddress, ReplicasAreAListOfOneFamily) {
  ExpectAddress("127.0.0.1:1,127.0.0.2:2", "ipv4:127.0.0.1:1,127.0.0.2:2", true,
                true);
  ExpectAddress("localhost:1,10.0.0.2:2", "ipv4:127.0.0.1:1,10.0.0.2:2", true,
                false);
  ExpectAddress("[::1]:1,[fd00::2]:2", "ipv6:[::1]:1,[fd00::2]:2", true, false);
}

TEST(ServerAddress, NameWithSeveralAddressesIsResolvedByGrpc) {
  ExpectAddress("dns:///terrane-headless:50051",
                "dns:///terrane-headless:50051", true, false);
  ExpectAddress("dns:///localhost:50051", "dns:///localhost:50051", true, true);
}

TEST(ServerAddress, WhatIsNoAddressIsNamed) {
  for (const char* text :
       {"", "localhost", "host:", ":50051", "host:port", "host:65536", "::1:80",
        "dns:///name", "127.0.0.1:1,", "127.0.0.1:1,,127.0.0.1:2"}) {
    const absl::Status status = ParseServerAddress(text).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << text;
    EXPECT_THAT(std::string(status.message()), HasSubstr("HOST:PORT")) << text;
  }
  for (const char* text :
       {"127.0.0.1:1,name:2", "127.0.0.1:1,[::1]:2", "[::1]:1,127.0.0.1:2"}) {
    EXPECT_THAT(std::string(ParseServerAddress(text).status().message()),
                HasSubstr("one family"))
        << text;
  }
}

}  // namespace
}  // namespace terrane::client
