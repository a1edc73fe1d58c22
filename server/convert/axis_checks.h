// Ranges along an axis of samples, or of whole tiles, and the check on them.
// Threads: any.
#ifndef TERRANE_SERVER_CONVERT_AXIS_CHECKS_H_
#define TERRANE_SERVER_CONVERT_AXIS_CHECKS_H_

#include <cstdint>

#include "core/base/field_checks.h"

namespace terrane::server {

// What may be asked for: [low, end).
struct Axis {
  std::int64_t low = 0;
  std::int64_t end = 0;
};

// Checks [first, first + count) on an axis.
inline bool CheckOnAxis(const Axis& axis, const core::Path& first_path,
                        std::int64_t first, const core::Path& count_path,
                        std::int64_t count, core::FieldChecks* checks) {
  const bool first_good =
      checks->Integer(first_path, first, axis.low, axis.end - 1);
  // A first that is wrong hides nothing of the count that would be wrong
  // whatever it was.
  const std::int64_t begin = first_good ? first : axis.low;
  return checks->Integer(count_path, count, 1, axis.end - begin) && first_good;
}

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_AXIS_CHECKS_H_
