// Violations: what is wrong with a request, field by field.
//
// Validation collects every violation in one pass instead of stopping at the
// first, so that a user mends a recipe once. A Status made from violations
// carries them as a payload; the server turns the payload into a BadRequest
// detail, the command line prints it line by line.
//
// Threads: a Violations object belongs to one thread. Errors: none.
#ifndef TERRANE_CORE_BASE_VIOLATIONS_H_
#define TERRANE_CORE_BASE_VIOLATIONS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"

namespace terrane::core {

// One violated field.
struct Violation {
  // Path of the field, such as "recipe.discrete_constraints[3].x".
  std::string field;
  // The range and the value that came: "must be in (0, 1), got 1.7".
  std::string description;

  bool operator==(const Violation&) const = default;
};

// Ordered list of violations; keeps the first kKept and counts the rest, so
// that a hostile request cannot make a large answer.
class Violations {
 public:
  static constexpr std::size_t kKept = 64;

  void Add(std::string field, std::string description);

  // The ones kept, in the order they came.
  const std::vector<Violation>& kept() const { return kept_; }
  // All that came, the ones not kept included.
  std::size_t total() const { return total_; }
  bool empty() const { return total_ == 0; }

  // OK when empty, else INVALID_ARGUMENT whose message lists the violations and
  // whose payload holds them (see ViolationsOf).
  absl::Status ToStatus() const;

 private:
  std::vector<Violation> kept_;
  std::size_t total_ = 0;
};

// An INVALID_ARGUMENT status with one violation.
absl::Status ViolationError(std::string field, std::string description);

// The violations that a status from ToStatus or ViolationError carries; empty
// for any other status.
std::vector<Violation> ViolationsOf(const absl::Status& status);

}  // namespace terrane::core

#endif  // TERRANE_CORE_BASE_VIOLATIONS_H_
