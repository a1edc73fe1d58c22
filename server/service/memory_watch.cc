#include "server/service/memory_watch.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <utility>
#include <vector>

#include "server/actor/control_group.h"

namespace terrane::server {
namespace {

constexpr std::chrono::milliseconds kReadingAge{5};
// New streams are refused above this share of the limit.
constexpr double kTightShare = 0.9;
// Giving memory back takes milliseconds.
constexpr std::chrono::seconds kGiveBackEvery{1};
// Version 1 writes no limit as the largest number of whole pages.
constexpr std::int64_t kUnlimited = std::int64_t{1} << 62;

// The limit in a file: a number of bytes, or "max".
std::optional<std::int64_t> LimitIn(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::int64_t bytes = 0;
  if (!(in >> bytes) || bytes >= kUnlimited) return std::nullopt;
  return bytes;
}

// Gives the kernel what was freed and is still with the allocator, which would
// count against the limit for ever. True when it was time to do so.
bool GiveBackFreed() {
  using Clock = std::chrono::steady_clock;
  static std::atomic<Clock::time_point> last = Clock::time_point();
  const Clock::time_point now = Clock::now();
  Clock::time_point before = last;
  if (now - before < kGiveBackEvery ||
      !last.compare_exchange_strong(before, now)) {
    return false;
  }
  malloc_trim(0);
  return true;
}

}  // namespace

std::int64_t ReadResidentBytes() {
  std::ifstream in("/proc/self/statm");
  std::int64_t total_pages = 0;
  std::int64_t resident_pages = 0;
  if (!(in >> total_pages >> resident_pages)) return 0;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

std::optional<std::int64_t> MemoryLimitWithin(
    const std::string& self_cgroup, const std::filesystem::path& cgroup_root) {
  std::vector<std::filesystem::path> files =
      FilesUpwards(cgroup_root, ControlGroupOf(self_cgroup, ""), "memory.max");
  const std::vector<std::filesystem::path> version_1 = FilesUpwards(
      cgroup_root / "memory", ControlGroupOf(self_cgroup, "memory"),
      "memory.limit_in_bytes");
  files.insert(files.end(), version_1.begin(), version_1.end());
  std::optional<std::int64_t> tightest;
  for (const std::filesystem::path& file : files) {
    const std::optional<std::int64_t> limit = LimitIn(file);
    if (limit.has_value()) {
      tightest = std::min(*limit, tightest.value_or(*limit));
    }
  }
  return tightest;
}

std::optional<std::int64_t> ControlGroupMemoryLimit() {
  return MemoryLimitWithin(SelfControlGroups(), kControlGroupRoot);
}

MemoryWatch::MemoryWatch(std::optional<std::int64_t> limit_bytes, Read read)
    : limit_bytes_(limit_bytes), read_(std::move(read)) {}

std::int64_t MemoryWatch::ResidentBytes() {
  std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (!read_at_.has_value() || now - *read_at_ >= kReadingAge) {
    resident_bytes_ = read_();
    read_at_ = now;
  }
  return resident_bytes_;
}

bool MemoryWatch::Tight() {
  if (!limit_bytes_.has_value()) return false;
  const double most = kTightShare * static_cast<double>(*limit_bytes_);
  if (static_cast<double>(ResidentBytes()) <= most) return false;
  if (GiveBackFreed()) {
    std::lock_guard lock(mutex_);
    read_at_.reset();
  }
  return static_cast<double>(ResidentBytes()) > most;
}

}  // namespace terrane::server
