// The acceptor with real sockets over loopback: the cap, running out of
// descriptors, the end.
#include "server/service/acceptor.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <chrono>
#include <ctime>
#include <mutex>
#include <thread>

#include "server/service/descriptor_limit.h"
#include "tests/server/fake_actor.h"

namespace terrane::server {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr std::chrono::seconds kStallLimit{60};

// A connected socket; not ok when nobody listens.
Descriptor Connect(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  Descriptor client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (connect(client.get(), reinterpret_cast<const sockaddr*>(&address),
              sizeof address) != 0) {
    return Descriptor();
  }
  return client;
}

// Waits for the other side to close; false after a minute.
bool IsClosedByPeer(const Descriptor& client) {
  pollfd wait{client.get(), POLLIN, 0};
  if (poll(&wait, 1, 60'000) != 1) return false;
  char byte = 0;
  return recv(client.get(), &byte, 1, 0) <= 0;
}

std::chrono::nanoseconds CpuTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) +
         std::chrono::nanoseconds(time.tv_nsec);
}

// Stands where gRPC stands: owns what was handed over, and shuts a socket down
// before it closes it.
class Owner {
 public:
  void Take(int fd) {
    std::lock_guard lock(mutex_);
    sockets_.emplace_back(fd);
  }
  std::size_t count() {
    std::lock_guard lock(mutex_);
    return sockets_.size();
  }
  void CloseOne() {
    std::lock_guard lock(mutex_);
    shutdown(sockets_.back().get(), SHUT_RDWR);
    sockets_.pop_back();
  }

 private:
  std::mutex mutex_;
  std::vector<Descriptor> sockets_;
};

class AcceptorTest : public testing::Test {
 protected:
  void Start(int max_connections) {
    auto acceptor =
        Acceptor::Listen("127.0.0.1:0", max_connections, kStallLimit);
    ASSERT_TRUE(acceptor.ok()) << acceptor.status();
    acceptor_ = *std::move(acceptor);
    acceptor_->Start([this](int fd) { owner_.Take(fd); });
  }
  bool Opens(int connections) {
    return Eventually([&] {
      return acceptor_->connections() == connections &&
             owner_.count() >= static_cast<std::size_t>(connections);
    });
  }

  Owner owner_;
  std::unique_ptr<Acceptor> acceptor_;
};

TEST_F(AcceptorTest, OneAboveTheCapIsClosedAtOnceAndAnEndedOneMakesRoom) {
  Start(2);
  const Descriptor first = Connect(acceptor_->port());
  const Descriptor second = Connect(acceptor_->port());
  ASSERT_TRUE(Opens(2));
  const Descriptor third = Connect(acceptor_->port());
  EXPECT_TRUE(IsClosedByPeer(third));
  EXPECT_EQ(acceptor_->refused(), 1);
  EXPECT_EQ(acceptor_->connections(), 2);

  owner_.CloseOne();
  // The watched duplicate does not hold the connection open.
  EXPECT_TRUE(IsClosedByPeer(second));
  ASSERT_TRUE(Opens(1));
  const Descriptor fourth = Connect(acceptor_->port());
  EXPECT_TRUE(Opens(2));
  EXPECT_EQ(acceptor_->refused(), 1);
}

TEST_F(AcceptorTest, ResetByTheClientMakesRoom) {
  Start(1);
  Descriptor client = Connect(acceptor_->port());
  ASSERT_TRUE(Opens(1));
  const linger at_once{1, 0};
  setsockopt(client.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  client = Descriptor();
  EXPECT_TRUE(Opens(0));
}

// Its owner still sends, so it still counts.
TEST_F(AcceptorTest, HalfClosedConnectionKeepsItsPlace) {
  Start(1);
  const Descriptor client = Connect(acceptor_->port());
  ASSERT_TRUE(Opens(1));
  shutdown(client.get(), SHUT_WR);
  EXPECT_TRUE(IsClosedByPeer(Connect(acceptor_->port())));
  EXPECT_EQ(acceptor_->connections(), 1);
  owner_.CloseOne();
  EXPECT_TRUE(Opens(0));
}

TEST_F(AcceptorTest, OutOfDescriptorsItWaitsWithoutSpinningAndRecovers) {
  Start(100);
  constexpr int kClients = 8;
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  // The connections come while no descriptor is left for them.
  std::vector<Descriptor> clients;
  for (int i = 0; i < kClients; ++i) {
    clients.emplace_back(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  }
  rlimit none = limit;
  none.rlim_cur = static_cast<rlim_t>(clients.back().get()) + 1;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  std::vector<Descriptor> plugs;  // what lies below the limit
  while (true) {
    Descriptor plug(fcntl(0, F_DUPFD_CLOEXEC, 0));
    if (!plug.ok()) break;
    plugs.push_back(std::move(plug));
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(acceptor_->port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (const Descriptor& client : clients) {
    ASSERT_EQ(connect(client.get(), reinterpret_cast<const sockaddr*>(&address),
                      sizeof address),
              0);
  }
  const auto before = CpuTime();
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_LT(CpuTime() - before, milliseconds(100));
  EXPECT_EQ(acceptor_->connections(), 0);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_TRUE(Opens(kClients));
  EXPECT_EQ(acceptor_->refused(), 0);
}

TEST_F(AcceptorTest, StopClosesTheDoorButNoConnection) {
  Start(10);
  const Descriptor client = Connect(acceptor_->port());
  ASSERT_TRUE(Opens(1));
  acceptor_->Stop();
  EXPECT_FALSE(Connect(acceptor_->port()).ok());
  pollfd wait{client.get(), POLLIN, 0};
  EXPECT_EQ(poll(&wait, 1, 50), 0);
}

TEST(AcceptorListen, TakesNumbersAndNames) {
  for (const char* address : {"127.0.0.1:0", "localhost:0", "0.0.0.0:0"}) {
    const auto acceptor = Acceptor::Listen(address, 1, kStallLimit);
    ASSERT_TRUE(acceptor.ok()) << acceptor.status();
    EXPECT_TRUE(Connect((*acceptor)->port()).ok()) << address;
  }
}

TEST(AcceptorListen, TakesIpv6) {
  const auto acceptor = Acceptor::Listen("[::1]:0", 1, kStallLimit);
  if (!acceptor.ok()) GTEST_SKIP() << "without IPv6: " << acceptor.status();
  EXPECT_GT((*acceptor)->port(), 0);
}

TEST(AcceptorListen, TakenPortIsAnError) {
  const auto first = Acceptor::Listen("127.0.0.1:0", 1, kStallLimit);
  ASSERT_TRUE(first.ok());
  const std::string address = "127.0.0.1:" + std::to_string((*first)->port());
  const auto second = Acceptor::Listen(address, 1, kStallLimit);
  EXPECT_EQ(second.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(second.status().message()),
              HasSubstr("cannot listen on " + address));
}

TEST(AcceptorListen, OtherFormsAreRefused) {
  for (const char* address : {"", "127.0.0.1", ":80", "127.0.0.1:", "a:65536",
                              "a:-1", "a:http", "unix:/socket"}) {
    EXPECT_EQ(Acceptor::Listen(address, 1, kStallLimit).status().code(),
              absl::StatusCode::kInvalidArgument)
        << address;
  }
}

TEST(FitConnections, StaysBelowTheLimitOfDescriptors) {
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_EQ(FitConnections(1), 1);
  const int most = FitConnections(1 << 30);
  EXPECT_LT(static_cast<rlim_t>(most), limit.rlim_max / 2);
  EXPECT_GE(most, 1);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
}

}  // namespace
}  // namespace terrane::server
