// A relay on the way to a server of this machine, which can fall silent as a
// machine that vanished does: its connections stay open and bring nothing.
#ifndef TERRANE_TESTS_CLIENT_RELAY_H_
#define TERRANE_TESTS_CLIENT_RELAY_H_

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace terrane::client {

class Relay {
 public:
  // To a port of 127.0.0.1. Every connection begins `late`.
  explicit Relay(int server_port, std::chrono::milliseconds late = {})
      : server_port_(server_port), late_(late), listener_(NewSocket()) {
    sockaddr_in address = Loopback(0);
    socklen_t size = sizeof address;
    bind(listener_, Any(&address), size);
    listen(listener_, 16);
    getsockname(listener_, Any(&address), &size);
    port_ = ntohs(address.sin_port);
    acceptor_ = std::jthread([this](std::stop_token stop) { Accept(stop); });
  }
  ~Relay() {
    acceptor_.request_stop();
    acceptor_.join();
    connections_.clear();
    close(listener_);
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  // Nothing more on the connections that there are.
  void FallSilent() { silent_below_ = count_.load(); }

 private:
  static int NewSocket() { return socket(AF_INET, SOCK_STREAM, 0); }
  static sockaddr* Any(sockaddr_in* address) {
    return reinterpret_cast<sockaddr*>(address);
  }
  static sockaddr_in Loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<in_port_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  static bool Readable(int socket) {
    pollfd file{socket, POLLIN, 0};
    return poll(&file, 1, 5) > 0;
  }

  void Accept(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (!Readable(listener_)) continue;
      const int client = accept(listener_, nullptr, nullptr);
      connections_.emplace_back(
          [this, client, number = count_++](std::stop_token ends) {
            Pass(client, number, ends);
          });
    }
  }

  void Pass(int client, int number, const std::stop_token& ends) {
    std::this_thread::sleep_for(late_);
    const int server = NewSocket();
    sockaddr_in address = Loopback(server_port_);
    bool open = connect(server, Any(&address), sizeof address) == 0;
    while (open && !ends.stop_requested()) {
      if (number < silent_below_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        continue;
      }
      open = PassSome(client, server) && PassSome(server, client);
    }
    close(client);
    close(server);
  }

  // False at the end.
  static bool PassSome(int from, int to) {
    if (!Readable(from)) return true;
    char bytes[4096];
    const ssize_t count = recv(from, bytes, sizeof bytes, 0);
    return count > 0 && send(to, bytes, static_cast<std::size_t>(count),
                             MSG_NOSIGNAL) == count;
  }

  const int server_port_;
  const std::chrono::milliseconds late_;
  const int listener_;
  int port_ = 0;
  std::atomic<int> count_ = 0;
  std::atomic<int> silent_below_ = 0;
  std::vector<std::jthread> connections_;
  std::jthread acceptor_;
};

}  // namespace terrane::client

#endif  // TERRANE_TESTS_CLIENT_RELAY_H_
