// CallBook: where every call is entered, once as it begins (the metrics count
// it) and once when it is over: a line in the log, its numbers in the metrics,
// its cost on its client's account.
//
// Threads: any. Costs microseconds and waits for no terminal and no network.
#ifndef TERRANE_SERVER_SERVICE_CALL_BOOK_H_
#define TERRANE_SERVER_SERVICE_CALL_BOOK_H_

#include "server/service/access.h"
#include "server/service/call_log.h"
#include "server/service/call_record.h"
#include "server/service/metrics.h"

namespace terrane::server {

class CallBook {
 public:
  // All outlive the book.
  CallBook(CallLog* log, Metrics* metrics, const Access* access)
      : log_(log), metrics_(metrics), access_(access) {}

  void Open(const CallRecord& record) { metrics_->CountBegun(record); }
  // The call is over now.
  void Close(CallRecord* record) {
    record->total = CallRecord::Clock::now() - record->begin;
    log_->Write(*record);
    metrics_->Record(*record);
    access_->Settle(*record);
    record->place.reset();
  }

 private:
  CallLog* const log_;
  Metrics* const metrics_;
  const Access* const access_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CALL_BOOK_H_
