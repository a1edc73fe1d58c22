#include "tests/bench/local_haproxy.h"

#include <arpa/inet.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

namespace terrane {
namespace {

sockaddr_in Loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

// A port that nobody listens on.
int FreePort() {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = Loopback(0);
  socklen_t size = sizeof address;
  bind(fd, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  close(fd);
  return ntohs(address.sin_port);
}

bool Answers(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = Loopback(port);
  const bool connected =
      connect(fd, reinterpret_cast<const sockaddr*>(&address),
              sizeof address) == 0;
  close(fd);
  return connected;
}

std::string Configuration(const std::vector<int>& ports,
                          const std::vector<int>& doors) {
  std::string text =
      "global\n"
      "  tune.h2.max-concurrent-streams 100\n"
      "  tune.h2.initial-window-size 65536\n"
      "  tune.h2.max-frame-size 16384\n"
      "defaults\n"
      "  mode http\n"
      "  timeout connect 2s\n"
      "  timeout client 60s\n"
      "  timeout server 60s\n"
      "  http-reuse always\n";
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const std::string name = "door" + std::to_string(i);
    text += "listen " + name +
            "\n  bind 127.0.0.1:" + std::to_string(doors[i]) +
            " proto h2\n  server " + name +
            " 127.0.0.1:" + std::to_string(ports[i]) + " proto h2\n";
  }
  return text;
}

absl::StatusOr<std::string> WriteTemporary(const std::string& text) {
  std::string name =
      std::filesystem::temp_directory_path() / "terrane-haproxy-XXXXXX";
  const int fd = mkstemp(name.data());
  if (fd < 0) return absl::UnavailableError("no temporary file");
  close(fd);
  std::ofstream(name) << text;
  return name;
}

}  // namespace

absl::StatusOr<std::unique_ptr<LocalHaproxy>> LocalHaproxy::Start(
    const std::vector<int>& ports) {
  std::unique_ptr<LocalHaproxy> proxy(new LocalHaproxy);
  for (std::size_t i = 0; i < ports.size(); ++i) {
    proxy->doors_.push_back(FreePort());
  }
  auto file = WriteTemporary(Configuration(ports, proxy->doors_));
  if (!file.ok()) return file.status();
  proxy->configuration_ = *std::move(file);
  // Debian keeps it out of other users' paths.
  std::string program = "/usr/sbin/haproxy", foreground = "-db", quiet = "-q";
  std::string option = "-f";
  char* const arguments[] = {program.data(),
                             quiet.data(),
                             foreground.data(),
                             option.data(),
                             proxy->configuration_.data(),
                             nullptr};
  if (posix_spawn(&proxy->process_, program.c_str(), nullptr, nullptr,
                  arguments, environ) != 0) {
    proxy->process_ = 0;
    return absl::NotFoundError("there is no " + program);
  }
  for (int i = 0; i < 500; ++i) {
    if (proxy->doors_.empty() || Answers(proxy->doors_.back())) return proxy;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return absl::UnavailableError("HAProxy does not start");
}

LocalHaproxy::~LocalHaproxy() {
  if (process_ != 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  if (!configuration_.empty()) unlink(configuration_.c_str());
}

}  // namespace terrane
