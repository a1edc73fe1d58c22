// Descriptor: a file descriptor that closes itself. Threads: as an int.
#ifndef TERRANE_SERVER_SERVICE_DESCRIPTOR_H_
#define TERRANE_SERVER_SERVICE_DESCRIPTOR_H_

#include <unistd.h>

#include <utility>

namespace terrane::server {

class Descriptor {
 public:
  Descriptor() = default;
  // Takes `fd` over; a negative one is none, as system calls answer it.
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (ok()) close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(other.Release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

  bool ok() const { return fd_ >= 0; }
  int get() const { return fd_; }
  // Gives the descriptor away.
  int Release() { return std::exchange(fd_, -1); }

 private:
  int fd_ = -1;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_DESCRIPTOR_H_
