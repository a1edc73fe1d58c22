#include "server/service/call_log.h"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <utility>

#include "server/actor/error_reason.h"
#include "server/service/status.h"

namespace terrane::server {
namespace {

// The content of a JSON string.
std::string Escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result.push_back('\\');
      result.push_back(c);
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      result += code;
    } else {
      result.push_back(c);
    }
  }
  return result;
}

// The variable part of a line: keys and values in either format.
class Line {
 public:
  Line(LogFormat format, std::string_view event) : format_(format) {
    if (format_ == LogFormat::kJson) {
      text_ = "\"event\":\"" + Escaped(event) + '"';
    } else {
      text_ = event;
    }
  }

  Line& Add(std::string_view key, std::string_view value) {
    // Quoted in text as well where a value may hold spaces.
    const bool quoted = format_ == LogFormat::kJson ||
                        value.find_first_of(" \"\n") != value.npos;
    Key(key);
    text_ += quoted ? '"' + Escaped(value) + '"' : std::string(value);
    return *this;
  }
  Line& Add(std::string_view key, std::int64_t value) {
    Key(key);
    text_ += std::to_string(value);
    return *this;
  }
  Line& AddMs(std::string_view key, std::chrono::nanoseconds value) {
    Key(key);
    char number[32];
    std::snprintf(number, sizeof number, "%.3f",
                  static_cast<double>(value.count()) * 1e-6);
    text_ += number;
    return *this;
  }

  const std::string& text() const { return text_; }

 private:
  void Key(std::string_view key) {
    if (format_ == LogFormat::kJson) {
      text_ += ",\"" + std::string(key) + "\":";
    } else {
      text_ += ' ' + std::string(key) + '=';
    }
  }

  const LogFormat format_;
  std::string text_;
};

// Why a call was refused, or what its error says that a program can read.
std::string Reason(const CallRecord& record) {
  if (record.refusal.has_value()) return NameOf(*record.refusal);
  const std::optional<ErrorReason> reason = ReasonOf(record.status);
  return reason.has_value() ? reason->reason : std::string();
}

std::chrono::nanoseconds Nanoseconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

CallLog::CallLog(std::shared_ptr<spdlog::logger> logger, LogFormat format)
    : logger_(std::move(logger)), format_(format) {
  logger_->set_pattern(
      format_ == LogFormat::kJson
          ? R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",%v})"
          : "%Y-%m-%dT%H:%M:%S.%e%z %l %v");
}

void CallLog::Write(const CallRecord& record) {
  const bool fault = IsServerFault(record.status);
  Line line(format_, "call");
  line.Add("request_id", record.request_id)
      .Add("method", record.method)
      .Add("code", CodeNameOf(record.status))
      .AddMs("total_ms", record.total)
      .AddMs("queue_ms", record.queued)
      .AddMs("generate_ms", record.generated)
      .AddMs("send_ms", record.sending);
  if (record.estimated_seconds > 0) {
    line.AddMs("estimate_ms", Nanoseconds(record.estimated_seconds));
  }
  if (!record.trace_id.empty()) line.Add("trace_id", record.trace_id);
  if (!record.recipe_hash.empty()) line.Add("recipe", record.recipe_hash);
  if (record.tiles > 0) {
    line.Add("tiles", record.tiles).Add("samples", record.samples);
  }
  if (record.bytes > 0) line.Add("bytes", record.bytes);
  if (const std::string reason = Reason(record); !reason.empty()) {
    line.Add("reason", reason);
  }
  if (fault) {
    const std::string text(record.status.message());
    line.Add("error", text);
  }
  logger_->log(fault ? spdlog::level::err : spdlog::level::info, "{}",
               line.text());
}

void CallLog::Event(std::string_view event, std::string_view detail) {
  Line line(format_, event);
  line.Add("detail", detail);
  logger_->info("{}", line.text());
}

std::shared_ptr<spdlog::logger> MakeStderrLogger(const std::string& level) {
  auto logger =
      spdlog::async_factory_nonblock::create<spdlog::sinks::stderr_sink_mt>(
          "terrane");
  logger->set_level(spdlog::level::from_str(level));
  return logger;
}

}  // namespace terrane::server
