#include "core/base/field_checks.h"

#include <charconv>
#include <iterator>
#include <utility>

namespace terrane::core {

std::string Path::Text() const {
  if (parent_ == nullptr) return *prefix_;
  std::string text = parent_->Text();
  // The prefix brings its own separator.
  if (parent_->parent_ != nullptr) text += '.';
  text += name_;
  if (index_.has_value()) {
    text += '[';
    text += std::to_string(*index_);
    text += ']';
  }
  return text;
}

bool Range::Holds(double value) const {
  return (open_low ? value > low : value >= low) &&
         (open_high ? value < high : value <= high);
}

std::string Range::Text() const {
  std::string text(1, open_low ? '(' : '[');
  text += NumberText(low) + ", " + NumberText(high);
  text += open_high ? ')' : ']';
  return text;
}

std::string NumberText(double value) {
  char text[32];
  const std::to_chars_result end =
      std::to_chars(std::begin(text), std::end(text), value);
  return std::string(std::begin(text), end.ptr);
}

void FieldChecks::Violate(const Path& path, std::string description) {
  violations_->Add(path.Text(), std::move(description));
}

bool FieldChecks::Number(const Path& path, double value, const Range& range) {
  if (range.Holds(value)) return true;
  Violate(path, "must be in " + range.Text() + ", got " + NumberText(value));
  return false;
}

bool FieldChecks::Number(const Path& path, std::optional<double> value,
                         const Range& range) {
  return !value.has_value() || Number(path, *value, range);
}

bool FieldChecks::Integer(const Path& path, std::int64_t value,
                          std::int64_t low, std::int64_t high) {
  if (value >= low && value <= high) return true;
  Violate(path, "must be in [" + std::to_string(low) + ", " +
                    std::to_string(high) + "], got " + std::to_string(value));
  return false;
}

bool FieldChecks::Count(const Path& path, std::size_t count, std::size_t low,
                        std::size_t high) {
  if (count >= low && count <= high) return true;
  const std::string range = count < low ? "at least " + std::to_string(low)
                                        : "at most " + std::to_string(high);
  Violate(path,
          "must have " + range + " elements, got " + std::to_string(count));
  return false;
}

}  // namespace terrane::core
