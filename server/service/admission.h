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
// An overloaded server admits up to the limit, so an expectation that is a
// little too good would have every call end a little too late. What streams
// really waited corrects it (`slip`). A server with nothing else to do tries
// calls that look too dear, within reason: a wrong price would last for ever.
//
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_ADMISSION_H_
#define TERRANE_SERVER_SERVICE_ADMISSION_H_

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>

#include "absl/status/statusor.h"
#include "server/service/price_book.h"
#include "server/service/worker_pool.h"

namespace terrane::server {

class Admission {
 public:
  using Seconds = std::chrono::duration<double>;
  // How long from now a call may take; nothing when it has no deadline.
  using TimeLeft = std::optional<Seconds>;

  Admission(const WorkerPool* workers, std::chrono::seconds patience)
      : workers_(workers), patience_(patience) {}

  PriceBook& prices() { return prices_; }

  // Of a call whose request is not read, at most half of the time that it has
  // left: it may be a small one among large ones, and an idle server finds out.
  static double Credible(double seconds, TimeLeft left) {
    if (!left.has_value()) return seconds;
    return std::min(seconds, std::max(left->count() / 2, 0.0));
  }
  // The class of a call of this price.
  static WorkClass ClassOf(double seconds);
  // What is expected of it, or the refusal (status.h, RetryLaterError).
  absl::StatusOr<Expectation> Admit(const Work& work, TimeLeft left) const;
  // A stream of which that was expected waited for workers and worked for
  // `actual_seconds`. One that was `cut_short` would have taken longer still.
  void Learn(const Expectation& expected, double actual_seconds,
             bool cut_short);

 private:
  Seconds Corrected(const Expectation& expected) const;

  const WorkerPool* const workers_;
  const std::chrono::seconds patience_;
  PriceBook prices_;
  mutable std::mutex mutex_;
  double slip_ = 1;  // what calls waited, by what was expected
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_ADMISSION_H_
