#include "server/service/linger.h"

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <utility>

namespace terrane::server {
namespace {

constexpr std::chrono::milliseconds kLookEvery{5};
// A peer that has said nothing for so long has read what it got.
constexpr std::chrono::milliseconds kQuiet{300};
// One that goes on talking, perhaps for another call, is not waited for longer.
constexpr std::chrono::milliseconds kLongestTalk{3000};

// The peer has reset the connection, or gRPC has closed it.
bool IsOver(int socket) {
  pollfd state{socket, 0, 0};
  return poll(&state, 1, 0) != 0;
}

bool HasUnsent(int socket) {
  int unsent = 0;
  return !IsOver(socket) && ioctl(socket, SIOCOUTQ, &unsent) == 0 && unsent > 0;
}

bool IsTalking(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  return !IsOver(socket) &&
         getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) == 0 &&
         std::chrono::milliseconds(info.tcpi_last_data_recv) < kQuiet;
}

int PortOf(const std::string& peer) {
  const std::size_t colon = peer.rfind(':');
  return colon == std::string::npos ? 0 : std::atoi(peer.c_str() + colon + 1);
}

}  // namespace

void Linger::Begin(FindSockets find, Clock::time_point until) {
  find_ = std::move(find);
  until_ = until;
  thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
  draining_ = true;
}

void Linger::Then(const std::string& peer, std::function<void()> end) {
  if (!draining_) return end();
  std::lock_guard lock(mutex_);
  waiting_.push_back({find_(PortOf(peer)), std::move(end), {}});
}

bool Linger::MayEnd(Waiting* one) const {
  const Clock::time_point now = Clock::now();
  if (now >= until_) return true;
  if (std::any_of(one->sockets.begin(), one->sockets.end(), HasUnsent)) {
    one->acknowledged = {};
    return false;
  }
  if (one->acknowledged == Clock::time_point()) one->acknowledged = now;
  return now - one->acknowledged >= kLongestTalk ||
         std::none_of(one->sockets.begin(), one->sockets.end(), IsTalking);
}

void Linger::Run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::vector<Waiting> ready;
    {
      std::lock_guard lock(mutex_);
      const auto first_ready =
          std::partition(waiting_.begin(), waiting_.end(),
                         [this](Waiting& one) { return !MayEnd(&one); });
      std::move(first_ready, waiting_.end(), std::back_inserter(ready));
      waiting_.erase(first_ready, waiting_.end());
    }
    // Without the lock: an end may bring another call here.
    for (const Waiting& one : ready) one.end();
    std::this_thread::sleep_for(kLookEvery);
  }
}

}  // namespace terrane::server
