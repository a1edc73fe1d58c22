#include "client/exit_code.h"

#include <iostream>

#include "core/base/violations.h"

namespace terrane::client {

int ExitCodeOf(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return kExitOk;
    case absl::StatusCode::kUnavailable:
      return kExitUnreachable;
    case absl::StatusCode::kCancelled:
      return kExitInterrupted;
    default:
      return kExitError;
  }
}

int ReportStatus(const absl::Status& status) {
  if (status.ok()) return kExitOk;
  const std::vector<core::Violation> violations = core::ViolationsOf(status);
  if (violations.empty()) {
    std::cerr << "terrane: " << status.message() << '\n';
  }
  for (const core::Violation& violation : violations) {
    std::cerr << "terrane: " << violation.field << ": " << violation.description
              << '\n';
  }
  return ExitCodeOf(status);
}

}  // namespace terrane::client
