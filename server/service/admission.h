// Admission: whether a call can be served in time, told before it costs
// anything.
//
// A call is judged twice: as it arrives, by the backlog that it meets, and, if
// it is a stream, once its request was read and it has a price. It is admitted
// when its expected finish is before its deadline. A call without a deadline is
// admitted when its first message is expected within the server's patience. The
// rest is refused at once with RESOURCE_EXHAUSTED and when to come back, which
// is kinder than an answer that is too late.
//
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_ADMISSION_H_
#define TERRANE_SERVER_SERVICE_ADMISSION_H_

#include <chrono>
#include <optional>

#include "absl/status/status.h"
#include "server/service/price_book.h"
#include "server/service/worker_pool.h"

namespace terrane::server {

class Admission {
 public:
  // How long from now a call may take; nothing when it has no deadline.
  using TimeLeft = std::optional<std::chrono::duration<double>>;

  Admission(const WorkerPool* workers, std::chrono::seconds patience)
      : workers_(workers), patience_(patience) {}

  PriceBook& prices() { return prices_; }

  // The class of a call of this price.
  static WorkClass ClassOf(double seconds);
  // OK, or the refusal (status.h, RetryLaterError).
  absl::Status Admit(const Work& work, TimeLeft left) const;

 private:
  const WorkerPool* const workers_;
  const std::chrono::seconds patience_;
  PriceBook prices_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_ADMISSION_H_
