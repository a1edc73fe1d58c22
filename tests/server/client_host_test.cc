// Which addresses are one client.
#include "server/service/client_host.h"

#include <gtest/gtest.h>

namespace terrane::server {
namespace {

TEST(ClientHost, AnIPv4AddressIsAClient) {
  EXPECT_EQ(ClientOfAddress("10.0.0.7"), "ipv4:10.0.0.7");
  EXPECT_EQ(ClientOfAddress("::ffff:10.0.0.7"), "ipv4:10.0.0.7");
}

TEST(ClientHost, AnIPv6NetworkIsAClient) {
  EXPECT_EQ(ClientOfAddress("2001:db8:1:2:3:4:5:6"), "ipv6:2001:db8:1:2::/64");
  EXPECT_EQ(ClientOfAddress("2001:db8:1:2::9"), "ipv6:2001:db8:1:2::/64");
  EXPECT_NE(ClientOfAddress("2001:db8:1:3::9"),
            ClientOfAddress("2001:db8:1:2::9"));
}

TEST(ClientHost, WhatIsNoAddressIsNoClient) {
  for (const char* text : {"", "nonsense", "10.0.0", "10.0.0.7:80", "[::1]"}) {
    EXPECT_FALSE(ClientOfAddress(text).has_value()) << text;
  }
}

TEST(ClientHost, PeersAreReadAsGrpcSaysThem) {
  EXPECT_EQ(ClientOfPeer("ipv4:10.0.0.7:4711"), "ipv4:10.0.0.7");
  EXPECT_EQ(ClientOfPeer("ipv6:%5B2001:db8::1%5D:4711"), "ipv6:2001:db8::/64");
  EXPECT_EQ(ClientOfPeer("ipv6:[2001:db8::1]:4711"), "ipv6:2001:db8::/64");
  EXPECT_EQ(ClientOfPeer("unix:/run/socket"), "unix:/run/socket");
  EXPECT_EQ(ClientOfPeer("unknown"), "unknown");
}

}  // namespace
}  // namespace terrane::server
