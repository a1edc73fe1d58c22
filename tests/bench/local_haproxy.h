// LocalHaproxy: HAProxy on loopback ports in front of loopback ports, for the
// life of the object.
//
// HTTP/2 on both sides and the frame limits of deploy/haproxy/haproxy.cfg; no
// health checks, since what is behind need not have any.
#ifndef TERRANE_TESTS_BENCH_LOCAL_HAPROXY_H_
#define TERRANE_TESTS_BENCH_LOCAL_HAPROXY_H_

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace terrane {

class LocalHaproxy {
 public:
  // One door for each port. NOT_FOUND where HAProxy is not installed,
  // UNAVAILABLE when it does not start within five seconds.
  static absl::StatusOr<std::unique_ptr<LocalHaproxy>> Start(
      const std::vector<int>& ports);
  // Ends the process.
  ~LocalHaproxy();
  LocalHaproxy(const LocalHaproxy&) = delete;
  LocalHaproxy& operator=(const LocalHaproxy&) = delete;

  // Where the doors are, in the order of the ports behind them.
  const std::vector<int>& doors() const { return doors_; }

 private:
  LocalHaproxy() = default;

  std::vector<int> doors_;
  std::string configuration_;  // a file, removed at the end
  pid_t process_ = 0;
};

}  // namespace terrane

#endif  // TERRANE_TESTS_BENCH_LOCAL_HAPROXY_H_
