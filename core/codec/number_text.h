// Numbers as text: the shortest that read back as the same value.
#ifndef TERRANE_CORE_CODEC_NUMBER_TEXT_H_
#define TERRANE_CORE_CODEC_NUMBER_TEXT_H_

#include <charconv>
#include <iterator>
#include <string>

namespace terrane::core {

template <typename Number>
void AppendNumber(Number value, std::string* text) {
  char digits[32];
  const std::to_chars_result end =
      std::to_chars(std::begin(digits), std::end(digits), value);
  text->append(std::begin(digits), end.ptr);
}

// After a separator.
template <typename Number>
void AppendNumber(char separator, Number value, std::string* text) {
  text->push_back(separator);
  AppendNumber(value, text);
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_CODEC_NUMBER_TEXT_H_
