// How `terrane` ends: its exit code, and what it says on standard error.
#ifndef TERRANE_CLIENT_EXIT_CODE_H_
#define TERRANE_CLIENT_EXIT_CODE_H_

#include "absl/status/status.h"

namespace terrane::client {

inline constexpr int kExitOk = 0;
inline constexpr int kExitError = 1;
inline constexpr int kExitUsage = 2;
// Some of several files were written; those are whole.
inline constexpr int kExitPartial = 3;
inline constexpr int kExitUnreachable = 4;
inline constexpr int kExitInterrupted = 130;

// The code of a status that ended a command.
int ExitCodeOf(const absl::Status& status);

// Prints an error to standard error, every violated field on a line of its own,
// and answers its exit code. Prints nothing when OK.
int ReportStatus(const absl::Status& status);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_EXIT_CODE_H_
