#include "server/service/process_stats.h"

#include <sys/resource.h>

#include <filesystem>
#include <iterator>
#include <system_error>

namespace terrane::server {
namespace {

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) +
         static_cast<double>(time.tv_usec) * 1e-6;
}

int EntriesOf(const char* folder) {
  std::error_code failed;
  const std::filesystem::directory_iterator entries(folder, failed);
  return failed ? 0
                : static_cast<int>(std::distance(begin(entries), end(entries)));
}

}  // namespace

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
}

int OpenFiles() {
  // The folder itself is open while it is read.
  const int entries = EntriesOf("/proc/self/fd");
  return entries > 0 ? entries - 1 : 0;
}

int ThreadCount() { return EntriesOf("/proc/self/task"); }

}  // namespace terrane::server
