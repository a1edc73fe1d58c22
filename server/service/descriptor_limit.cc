#include "server/service/descriptor_limit.h"

#include <sys/resource.h>

#include <algorithm>

namespace terrane::server {
namespace {

// The connection's own, and the one that server/service/acceptor.h watches.
constexpr rlim_t kPerConnection = 2;
// For all else (listeners, epoll sets, files of certificates), with plenty to
// spare; half of a limit that is lower than twice this.
constexpr rlim_t kSpare = 256;

}  // namespace

int FitConnections(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
  const rlim_t needed = kPerConnection * static_cast<rlim_t>(wanted) + kSpare;
  if (limit.rlim_cur < needed) {
    rlimit raised = limit;
    raised.rlim_cur = std::min(needed, limit.rlim_max);
    if (setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
  }
  const rlim_t spare = std::min(kSpare, limit.rlim_cur / 2);
  const rlim_t fit = (limit.rlim_cur - spare) / kPerConnection;
  return static_cast<int>(
      std::clamp<rlim_t>(fit, 1, static_cast<rlim_t>(wanted)));
}

}  // namespace terrane::server
