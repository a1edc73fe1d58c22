#include "core/base/violations.h"

#include <utility>

#include "absl/strings/cord.h"
#include "absl/types/optional.h"

namespace terrane::core {
namespace {

constexpr char kPayloadType[] = "terrane.violations";

// The payload is the kept violations as field, NUL, description, NUL: neither
// text ever holds a NUL.
void AppendPayload(const Violation& violation, std::string* payload) {
  payload->append(violation.field);
  payload->push_back('\0');
  payload->append(violation.description);
  payload->push_back('\0');
}

// A hostile text may hold anything, so what would break the framing goes.
std::string WithoutNul(std::string text) {
  std::erase(text, '\0');
  return text;
}

}  // namespace

void Violations::Add(std::string field, std::string description) {
  ++total_;
  if (kept_.size() < kKept) {
    kept_.push_back(
        {WithoutNul(std::move(field)), WithoutNul(std::move(description))});
  }
}

absl::Status Violations::ToStatus() const {
  if (empty()) return absl::OkStatus();
  std::string message;
  std::string payload;
  for (const Violation& violation : kept_) {
    if (!message.empty()) message += "; ";
    message += violation.field + ": " + violation.description;
    AppendPayload(violation, &payload);
  }
  if (total_ > kept_.size()) {
    const Violation more{
        "(more)", "and " + std::to_string(total_ - kept_.size()) + " more"};
    message += "; " + more.description;
    AppendPayload(more, &payload);
  }
  absl::Status status = absl::InvalidArgumentError(message);
  status.SetPayload(kPayloadType, absl::Cord(payload));
  return status;
}

absl::Status ViolationError(std::string field, std::string description) {
  Violations violations;
  violations.Add(std::move(field), std::move(description));
  return violations.ToStatus();
}

std::vector<Violation> ViolationsOf(const absl::Status& status) {
  std::vector<Violation> result;
  const absl::optional<absl::Cord> payload = status.GetPayload(kPayloadType);
  if (!payload.has_value()) return result;
  const std::string text(*payload);
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t field_end = text.find('\0', at);
    const std::size_t end = text.find('\0', field_end + 1);
    result.push_back({text.substr(at, field_end - at),
                      text.substr(field_end + 1, end - field_end - 1)});
    at = end + 1;
  }
  return result;
}

}  // namespace terrane::core
