#include "server/service/trace_context.h"

#include <algorithm>

namespace terrane::server {
namespace {

constexpr std::size_t kVersionDigits = 2;
constexpr std::size_t kTraceIdDigits = 32;
constexpr std::size_t kParentIdDigits = 16;
constexpr std::size_t kFlagsDigits = 2;

// Takes `digits` lower-case hexadecimal digits off the front of `text`; empty
// when they are not there.
std::string_view TakeHex(std::size_t digits, std::string_view* text) {
  const std::string_view taken = text->substr(0, digits);
  const bool hex = taken.size() == digits &&
                   std::all_of(taken.begin(), taken.end(), [](char c) {
                     return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
                   });
  if (!hex) return {};
  text->remove_prefix(digits);
  return taken;
}

bool TakeDash(std::string_view* text) {
  if (!text->starts_with('-')) return false;
  text->remove_prefix(1);
  return true;
}

// An id of zeros says that there is none.
bool IsId(std::string_view id) { return id.find_first_not_of('0') != id.npos; }

}  // namespace

std::optional<std::string> TraceIdOf(std::string_view traceparent) {
  std::string_view rest = traceparent;
  const std::string_view version = TakeHex(kVersionDigits, &rest);
  if (version.empty() || version == "ff" || !TakeDash(&rest)) {
    return std::nullopt;
  }
  const std::string_view trace_id = TakeHex(kTraceIdDigits, &rest);
  if (!IsId(trace_id) || !TakeDash(&rest)) return std::nullopt;
  const std::string_view parent_id = TakeHex(kParentIdDigits, &rest);
  if (!IsId(parent_id) || !TakeDash(&rest)) return std::nullopt;
  if (TakeHex(kFlagsDigits, &rest).empty()) return std::nullopt;
  const bool ends_well =
      rest.empty() || (version != "00" && rest.starts_with('-'));
  if (!ends_well) return std::nullopt;
  return std::string(trace_id);
}

}  // namespace terrane::server
