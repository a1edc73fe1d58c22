// One structured line per call, and the server's own events.
//
// Lines go through an asynchronous spdlog logger, so that no worker ever waits
// for a terminal or a pipe: when the queue is full the oldest line is dropped.
// Text: "time level event key=value ..."; JSON: one object a line. No line
// holds a path, a token or a request's content.
//
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_CALL_LOG_H_
#define TERRANE_SERVER_SERVICE_CALL_LOG_H_

#include <spdlog/logger.h>

#include <memory>
#include <string>
#include <string_view>

#include "server/service/call_record.h"

namespace terrane::server {

enum class LogFormat { kText, kJson };

class CallLog {
 public:
  // `logger` has no pattern of its own yet.
  CallLog(std::shared_ptr<spdlog::logger> logger, LogFormat format);

  // The line of a call that is over. A fault of the server is an error, with
  // its text; everything else is information.
  void Write(const CallRecord& record);
  // A line of the server itself, such as "listening".
  void Event(std::string_view event, std::string_view detail);

 private:
  const std::shared_ptr<spdlog::logger> logger_;
  const LogFormat format_;
};

// A logger to standard error that never blocks. `level` is spdlog's: trace,
// debug, info, warning, error, critical, off.
std::shared_ptr<spdlog::logger> MakeStderrLogger(const std::string& level);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CALL_LOG_H_
