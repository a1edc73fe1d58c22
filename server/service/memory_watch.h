// MemoryWatch: how near the process is to the memory it may take.
//
// Past the limit of its control group the kernel kills the process, and with it
// every call. So the server turns new streams away while the resident set is
// above nine tenths of the limit; those it has go on and give their memory
// back.
//
// Threads: any. Readings are at most 5 ms old, in which uploads bring some
// megabytes, and cost microseconds, so every call may ask.
#ifndef TERRANE_SERVER_SERVICE_MEMORY_WATCH_H_
#define TERRANE_SERVER_SERVICE_MEMORY_WATCH_H_

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace terrane::server {

// The resident set of this process; 0 where /proc does not tell.
std::int64_t ReadResidentBytes();

// The limit of this process's control group; nothing where there is none.
std::optional<std::int64_t> ControlGroupMemoryLimit();

// The same with the text of /proc/self/cgroup and the place where the cgroup
// file systems are mounted: the tightest limit of the group and of those above
// it, of version 2 (memory.max) and of version 1 (memory.limit_in_bytes).
std::optional<std::int64_t> MemoryLimitWithin(
    const std::string& self_cgroup, const std::filesystem::path& cgroup_root);

class MemoryWatch {
 public:
  using Read = std::function<std::int64_t()>;

  // Without a limit it is never tight.
  explicit MemoryWatch(std::optional<std::int64_t> limit_bytes,
                       Read read = ReadResidentBytes);

  std::optional<std::int64_t> limit_bytes() const { return limit_bytes_; }
  std::int64_t ResidentBytes();
  // Whether new streams are to be refused.
  bool Tight();

 private:
  using Clock = std::chrono::steady_clock;

  const std::optional<std::int64_t> limit_bytes_;
  const Read read_;
  std::mutex mutex_;
  std::optional<Clock::time_point> read_at_;
  std::int64_t resident_bytes_ = 0;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_MEMORY_WATCH_H_
