#include "client/patience.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace terrane::client {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstWait{100};
constexpr milliseconds kLongestWait{2'000};
constexpr milliseconds kLongestAskedWait{30'000};

}  // namespace

milliseconds WaitBeforeNextTry(int failures, std::optional<milliseconds> asked,
                               double spread) {
  const milliseconds middle =
      std::min(kFirstWait * (1 << std::min(failures - 1, 10)), kLongestWait);
  const auto wait = std::chrono::duration_cast<milliseconds>(
      (0.5 + spread) * std::chrono::duration<double, std::milli>(middle));
  return wait + std::min(asked.value_or(milliseconds(0)), kLongestAskedWait);
}

bool SleepFor(milliseconds duration, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, duration, [] { return false; });
  return !stop.stop_requested();
}

}  // namespace terrane::client
