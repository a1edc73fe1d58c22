// Ends of calls in a drain, with real sockets over loopback.
#include "server/service/linger.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/service/descriptor.h"
#include "tests/server/fake_actor.h"

namespace terrane::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// A connection of this process with itself.
class LingerTest : public testing::Test {
 protected:
  void SetUp() override {
    const Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    socklen_t size = sizeof address;
    ASSERT_EQ(bind(listener.get(), generic, size), 0);
    ASSERT_EQ(listen(listener.get(), 1), 0);
    ASSERT_EQ(getsockname(listener.get(), generic, &size), 0);
    reader_ = Descriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    ASSERT_EQ(connect(reader_.get(), generic, size), 0);
    ASSERT_EQ(getsockname(reader_.get(), generic, &size), 0);
    reader_port_ = ntohs(address.sin_port);
    server_ = Descriptor(accept4(listener.get(), nullptr, nullptr,
                                 SOCK_NONBLOCK | SOCK_CLOEXEC));
    ASSERT_TRUE(server_.ok());
  }

  void Begin(milliseconds drain) {
    linger_.Begin(
        [this](int port) {
          return port == reader_port_ ? std::vector<int>{server_.get()}
                                      : std::vector<int>{};
        },
        Linger::Clock::now() + drain);
  }
  void EndCall(int port) {
    linger_.Then("ipv4:127.0.0.1:" + std::to_string(port),
                 [this] { ended_ = true; });
  }
  // Sends what the kernel takes without anybody who reads.
  void Fill() {
    const std::string bytes(1 << 16, 'x');
    while (send(server_.get(), bytes.data(), bytes.size(), 0) > 0) {
    }
  }
  bool EndsSoon() {
    return Eventually([this] { return ended_.load(); });
  }
  bool StaysFor(milliseconds time) {
    std::this_thread::sleep_for(time);
    return !ended_;
  }
  // How long the end of a call waits for a peer that talks all the time;
  // nothing when the peer was quiet for a moment, as this machine stood still.
  std::optional<Linger::Clock::duration> StaysWhileThePeerTalks() {
    ended_ = false;
    const auto begin = Linger::Clock::now();
    auto last = begin;
    Linger::Clock::duration largest_gap{0};
    const auto talk = [&] {
      const auto now = Linger::Clock::now();
      largest_gap = std::max(largest_gap, now - last);
      last = now;
      send(reader_.get(), "x", 1, 0);
      // Taken, so that there is always room for more.
      char said[64];
      while (recv(server_.get(), said, sizeof said, MSG_DONTWAIT) > 0) {
      }
    };
    talk();
    EndCall(reader_port_);
    EXPECT_TRUE(Eventually([&] {
      talk();
      return ended_.load();
    }));
    if (largest_gap > milliseconds(100)) return std::nullopt;
    return Linger::Clock::now() - begin;
  }

  Descriptor reader_, server_;
  int reader_port_ = 0;
  std::atomic<bool> ended_ = false;
  Linger linger_;
};

TEST_F(LingerTest, OutsideOfADrainNothingWaits) {
  Fill();
  EndCall(reader_port_);
  EXPECT_TRUE(ended_);
}

TEST_F(LingerTest, WhatWasSentToAQuietPeerNeedsNoWait) {
  Begin(seconds(60));
  EndCall(reader_port_);
  EXPECT_TRUE(EndsSoon());
}

TEST_F(LingerTest, AnUnknownPeerNeedsNoWait) {
  Begin(seconds(60));
  Fill();
  EndCall(reader_port_ + 1);
  EXPECT_TRUE(EndsSoon());
}

TEST_F(LingerTest, TheEndWaitsForASlowReader) {
  Begin(seconds(60));
  Fill();
  EndCall(reader_port_);
  EXPECT_TRUE(StaysFor(milliseconds(100)));
  std::vector<char> bytes(1 << 16);
  EXPECT_TRUE(Eventually([&] {
    while (recv(reader_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) {
    }
    return ended_.load();
  }));
}

TEST_F(LingerTest, TheEndWaitsWhileThePeerTalksButNotForEver) {
  Begin(seconds(600));
  std::optional<Linger::Clock::duration> waited;
  for (int attempt = 0; attempt < 20 && !waited.has_value(); ++attempt) {
    waited = StaysWhileThePeerTalks();
  }
  ASSERT_TRUE(waited.has_value());
  EXPECT_GE(*waited, seconds(3));
}

TEST_F(LingerTest, AReaderThatHasGoneIsNotWaitedFor) {
  Begin(seconds(60));
  Fill();
  EndCall(reader_port_);
  const struct linger at_once { 1, 0 };
  setsockopt(reader_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  reader_ = Descriptor();
  EXPECT_TRUE(EndsSoon());
}

TEST_F(LingerTest, ADrainIsNotHeldUpBeyondItsTime) {
  const auto until = Linger::Clock::now() + milliseconds(300);
  Begin(milliseconds(300));
  Fill();
  EndCall(reader_port_);
  EXPECT_TRUE(StaysFor(milliseconds(50)) || Linger::Clock::now() >= until);
  EXPECT_TRUE(EndsSoon());
}

}  // namespace
}  // namespace terrane::server
