#include "client/csv.h"

#include <charconv>
#include <iostream>
#include <optional>
#include <span>

#include "client/output_file.h"

namespace terrane::client {
namespace {

constexpr char kBlank[] = " \t\r";

std::optional<double> ParseNumber(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string::npos) return std::nullopt;
  const std::size_t last = text.find_last_not_of(kBlank);
  double number = 0;
  const char* end = text.data() + last + 1;
  const auto result = std::from_chars(text.data() + first, end, number);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

// The numbers of a line; nothing when one of its fields is none.
std::optional<std::vector<double>> ParseLine(const std::string& line) {
  std::vector<double> numbers;
  std::size_t at = 0;
  while (true) {
    const std::size_t comma = line.find(',', at);
    const std::optional<double> number =
        ParseNumber(line.substr(at, comma - at));
    if (!number.has_value()) return std::nullopt;
    numbers.push_back(*number);
    if (comma == std::string::npos) return numbers;
    at = comma + 1;
  }
}

}  // namespace

absl::StatusOr<std::vector<std::vector<double>>> ReadCsv(
    std::istream* input, const std::string& name, std::size_t columns) {
  std::vector<std::vector<double>> table;
  std::string line;
  for (std::size_t number = 1; std::getline(*input, line); ++number) {
    if (line.find_first_not_of(kBlank) == std::string::npos) continue;
    const std::optional<std::vector<double>> row = ParseLine(line);
    if (!row.has_value() && number == 1) continue;
    const std::size_t expected = table.empty() ? columns : table.size();
    if (!row.has_value() || row->size() < expected) {
      return absl::InvalidArgumentError(
          name + " line " + std::to_string(number) + ": must be " +
          std::to_string(expected) + " numbers divided by commas, got \"" +
          line.substr(0, 60) + "\"");
    }
    if (table.empty()) table.resize(row->size());
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i].push_back((*row)[i]);
    }
  }
  if (table.empty()) {
    return absl::InvalidArgumentError(name + ": has no row of numbers");
  }
  return table;
}

absl::Status WriteText(const std::string& path, const std::string& text) {
  if (path != "-") return WriteFile(path, std::as_bytes(std::span(text)));
  std::cout << text << std::flush;
  if (std::cout) return absl::OkStatus();
  return absl::UnknownError("cannot write to standard output");
}

}  // namespace terrane::client
