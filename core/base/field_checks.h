// What every validator shares: field paths that are spelled only when something
// is wrong, ranges that print themselves, and the checks on them.
//
// A check adds a violation and returns false when the value is out of range;
// NaN is in no range. Safe from any thread; a Violations object belongs to one.
#ifndef TERRANE_CORE_BASE_FIELD_CHECKS_H_
#define TERRANE_CORE_BASE_FIELD_CHECKS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/violations.h"

namespace terrane::core {

// A chain of field names that ends at the field in hand. It points at its
// parent, so a Path that has a name must have a parent that has one too:
//   const Path cone = part.Field("cone");
//   checks.Number(cone.Field("radius"), ...);
class Path {
 public:
  // `prefix` stands before the whole path and must outlive it.
  explicit Path(const std::string* prefix) : prefix_(prefix) {}

  Path Field(const char* name) const { return Path(this, name, std::nullopt); }
  // Element `index` of the repeated field `name`.
  Path Element(const char* name, std::size_t index) const {
    return Path(this, name, index);
  }

  // Such as "recipe.macro.parts[2].cone.radius" for the prefix "recipe.".
  std::string Text() const;

 private:
  Path(const Path* parent, const char* name, std::optional<std::size_t> index)
      : parent_(parent), name_(name), index_(index) {}

  const std::string* prefix_ = nullptr;  // of the root only
  const Path* parent_ = nullptr;
  const char* name_ = "";
  std::optional<std::size_t> index_;
};

// An interval of numbers; a bound that is open does not belong to it.
struct Range {
  double low = 0;
  double high = 0;
  bool open_low = false;
  bool open_high = false;

  bool Holds(double value) const;
  // Such as "(0, 1]".
  std::string Text() const;
};

// The shortest text that reads back as the same number.
std::string NumberText(double value);

// One validation in progress.
class FieldChecks {
 public:
  explicit FieldChecks(Violations* violations) : violations_(violations) {}

  void Violate(const Path& path, std::string description);
  bool Number(const Path& path, double value, const Range& range);
  // The same, when there is a value at all.
  bool Number(const Path& path, std::optional<double> value,
              const Range& range);
  bool Integer(const Path& path, std::int64_t value, std::int64_t low,
               std::int64_t high);
  // A repeated field with `count` elements.
  bool Count(const Path& path, std::size_t count, std::size_t low,
             std::size_t high);

 private:
  Violations* const violations_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_BASE_FIELD_CHECKS_H_
