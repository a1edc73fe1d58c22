#include "tests/client/disk_calls.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

namespace terrane::client {

std::vector<std::string>& DiskCalls() {
  static std::vector<std::string> calls;
  return calls;
}

}  // namespace terrane::client

// In place of the C library's.
extern "C" int fsync(int descriptor) {
  const auto link = "/proc/self/fd/" + std::to_string(descriptor);
  terrane::client::DiskCalls().push_back(
      "fsync " + std::filesystem::read_symlink(link).string());
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  terrane::client::DiskCalls().push_back("rename " + std::string(from) +
                                         " to " + to);
  return renameat(AT_FDCWD, from, AT_FDCWD, to);
}
