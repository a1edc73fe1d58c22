#include "server/service/acceptor.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace terrane::server {
namespace {

constexpr int kMaxEvents = 64;
// Accepted in a row before ended connections get their turn.
constexpr int kAcceptsInARow = 64;
constexpr int kPauseMs = 50;

void SetOption(int fd, int level, int option, int value) {
  setsockopt(fd, level, option, &value, sizeof value);
}

// NOT_FOUND for an address that this machine is without.
absl::Status SystemError(const std::string& call) {
  const int error = errno;
  const std::string text = call + ": " + std::strerror(error);
  return error == EADDRNOTAVAIL || error == EAFNOSUPPORT
             ? absl::NotFoundError(text)
             : absl::UnavailableError(text);
}

int PortIn(const sockaddr_storage& address) {
  // At the same place for both families.
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

// The port a socket is bound to.
int PortOf(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return PortIn(address);
}

// A listening socket; `port` unless it is 0. Sockets accepted from it inherit
// the options of TCP.
absl::StatusOr<Descriptor> ListeningSocket(
    const addrinfo& info, int port, std::chrono::milliseconds stall_limit) {
  Descriptor socket_fd(
      socket(info.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket_fd.ok()) return SystemError("socket");
  const int fd = socket_fd.get();
  // A restarted server does not wait for the connections of the one before.
  // Never SO_REUSEPORT: two servers on a port would share its calls at random.
  SetOption(fd, SOL_SOCKET, SO_REUSEADDR, 1);
  SetOption(fd, IPPROTO_TCP, TCP_NODELAY, 1);
  // Counts while the peer's window is closed, too, which it acknowledges.
  SetOption(fd, IPPROTO_TCP, TCP_USER_TIMEOUT,
            static_cast<int>(stall_limit.count()));
  sockaddr_storage address{};
  std::memcpy(&address, info.ai_addr, info.ai_addrlen);
  if (port != 0) {
    reinterpret_cast<sockaddr_in*>(&address)->sin_port =
        htons(static_cast<std::uint16_t>(port));
  }
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), info.ai_addrlen) !=
      0) {
    return SystemError("bind");
  }
  if (listen(fd, SOMAXCONN) != 0) return SystemError("listen");
  return socket_fd;
}

// Errors of accept that are the one connection's, which has gone again.
bool IsOfTheConnection(int error) {
  switch (error) {
    case EINTR:
    case ECONNABORTED:
    case EPROTO:
    case EPERM:
    case ENETDOWN:
    case ENOPROTOOPT:
    case EHOSTDOWN:
    case ENONET:
    case EHOSTUNREACH:
    case EOPNOTSUPP:
    case ENETUNREACH:
      return true;
    default:
      return false;
  }
}

// Closes with a reset, which leaves no socket behind to wait.
void Reset(Descriptor connection) {
  const linger at_once{1, 0};
  setsockopt(connection.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Acceptor>> Acceptor::Listen(
    const std::string& address, int max_connections,
    std::chrono::milliseconds stall_limit) {
  const std::size_t colon = address.rfind(':');
  std::string host = address.substr(0, colon);
  const std::string port =
      colon == std::string::npos ? "" : address.substr(colon + 1);
  const bool is_number = !port.empty() && port.size() <= 5 &&
                         std::all_of(port.begin(), port.end(), [](char c) {
                           return c >= '0' && c <= '9';
                         });
  if (host.empty() || !is_number || std::stoi(port) > 65535) {
    return absl::InvalidArgumentError(
        "address to listen on must be ADDRESS:PORT with a port from 0 to "
        "65535, got " +
        address);
  }
  if (host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  std::unique_ptr<Acceptor> acceptor(new Acceptor(max_connections));
  const absl::Status status = acceptor->ListenOn(host, port, stall_limit);
  if (!status.ok()) {
    return absl::UnavailableError("cannot listen on " + address + ": " +
                                  std::string(status.message()));
  }
  return acceptor;
}

absl::Status Acceptor::ListenOn(const std::string& host,
                                const std::string& port,
                                std::chrono::milliseconds stall_limit) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  if (error != 0) return absl::UnavailableError(gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> infos(found,
                                                                 freeaddrinfo);
  absl::Status problem;
  for (const addrinfo* info = found; info != nullptr; info = info->ai_next) {
    auto socket_fd = ListeningSocket(*info, port_, stall_limit);
    if (socket_fd.ok()) {
      port_ = PortOf(socket_fd->get());
      listeners_.push_back(*std::move(socket_fd));
    } else if (absl::IsNotFound(socket_fd.status())) {
      // A name may stand for an address of a family that is turned off.
      problem = socket_fd.status();
    } else {
      return socket_fd.status();
    }
  }
  if (listeners_.empty()) return problem;
  epoll_ = Descriptor(epoll_create1(EPOLL_CLOEXEC));
  stop_event_ = Descriptor(eventfd(0, EFD_CLOEXEC));
  if (!epoll_.ok() || !Watch(stop_event_.get(), EPOLLIN)) {
    return SystemError("epoll");
  }
  for (const Descriptor& listener : listeners_) {
    if (!Watch(listener.get(), EPOLLIN)) return SystemError("epoll");
  }
  return absl::OkStatus();
}

Acceptor::~Acceptor() { Stop(); }

void Acceptor::Start(TakeConnection take, OnRefused on_refused) {
  take_ = std::move(take);
  on_refused_ = std::move(on_refused);
  thread_ = std::thread([this] { Run(); });
}

void Acceptor::Stop() {
  if (thread_.joinable()) {
    eventfd_write(stop_event_.get(), 1);
    thread_.join();
  }
  listeners_.clear();
  connections_ = 0;
}

std::vector<int> Acceptor::SocketsFrom(int peer_port) const {
  std::vector<int> found;
  for (const auto& [fd, duplicate] : watched_) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getpeername(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
        PortIn(address) == peer_port) {
      found.push_back(fd);
    }
  }
  return found;
}

bool Acceptor::Watch(int fd, std::uint32_t events) {
  epoll_event event{};
  event.events = events;
  event.data.fd = fd;
  return epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event) == 0;
}

void Acceptor::WakeOnConnections(bool on) {
  for (const Descriptor& listener : listeners_) {
    epoll_event event{};
    event.events = on ? std::uint32_t{EPOLLIN} : 0U;
    event.data.fd = listener.get();
    epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, listener.get(), &event);
  }
}

void Acceptor::Run() {
  std::array<epoll_event, kMaxEvents> events{};
  bool paused = false;
  while (true) {
    const int count = epoll_wait(epoll_.get(), events.data(), kMaxEvents,
                                 paused ? kPauseMs : -1);
    // Ended connections first: they make room for the new ones.
    std::vector<int> ready;
    for (int i = 0; i < count; ++i) {
      const epoll_event& event = events[static_cast<std::size_t>(i)];
      const int fd = event.data.fd;
      if (fd == stop_event_.get()) return;
      if (!watched_.contains(fd)) {
        ready.push_back(fd);
      } else if ((event.events & EPOLLHUP) != 0) {
        // gRPC's own descriptor may keep the socket open, and with it what
        // epoll knows of this one, whose number another may have next.
        epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, fd, nullptr);
        watched_.erase(fd);
        --connections_;
      }
    }
    // Whatever ended the pause, it is worth a try.
    if (std::exchange(paused, false)) WakeOnConnections(true);
    for (const int listener : ready) {
      if (AcceptFrom(listener)) continue;
      paused = true;
      WakeOnConnections(false);
      break;
    }
  }
}

bool Acceptor::AcceptFrom(int listener) {
  for (int i = 0; i < kAcceptsInARow; ++i) {
    Descriptor connection(
        accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (connection.ok()) {
      if (!HandOver(std::move(connection))) return false;
    } else if (errno == EAGAIN) {
      return true;
    } else if (!IsOfTheConnection(errno)) {
      return false;
    }
  }
  return true;
}

bool Acceptor::HandOver(Descriptor connection) {
  if (connections_ >= max_connections_) {
    ++refused_;
    on_refused_();
    Reset(std::move(connection));
    return true;
  }
  Descriptor duplicate(fcntl(connection.get(), F_DUPFD_CLOEXEC, 0));
  // No events but EPOLLHUP and EPOLLERR, which always come; each once.
  if (!duplicate.ok() || !Watch(duplicate.get(), EPOLLET)) return false;
  const int fd = duplicate.get();
  watched_.emplace(fd, std::move(duplicate));
  ++connections_;
  take_(connection.Release());
  return true;
}

}  // namespace terrane::server
