// The trace that a call belongs to, after W3C Trace Context
// (https://www.w3.org/TR/trace-context/, level 1).
#ifndef TERRANE_SERVER_SERVICE_TRACE_CONTEXT_H_
#define TERRANE_SERVER_SERVICE_TRACE_CONTEXT_H_

#include <optional>
#include <string>
#include <string_view>

namespace terrane::server {

// The trace id, 32 hexadecimal digits, of a traceparent header:
// VERSION-TRACE_ID-PARENT_ID-FLAGS, such as
// "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01". Nothing when it is
// malformed, which the standard says to treat as if it had not come. Versions
// to come may add fields at the end.
std::optional<std::string> TraceIdOf(std::string_view traceparent);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_TRACE_CONTEXT_H_
