#include "client/csv.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iostream>
#include <optional>
#include <span>
#include <string_view>

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

std::string Trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// The fields of a line without blanks around them. A field in quotes may hold
// commas, and a quote as two.
std::vector<std::string> SplitFields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled) fields.back() += line[++i];
      if (!doubled) quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  for (std::string& field : fields) field = Trimmed(field);
  return fields;
}

std::string LowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(c & 0x7F));
  return text;
}

absl::Status LineError(const std::string& name, std::int64_t line,
                       const std::string& what) {
  return absl::InvalidArgumentError(name + " line " + std::to_string(line) +
                                    ": " + what);
}

// Where each wanted column stands in the line that names them.
absl::StatusOr<std::vector<std::optional<std::size_t>>> FindColumns(
    const std::string& header, const std::string& name,
    const std::vector<CsvColumn>& wanted) {
  const std::vector<std::string> fields = SplitFields(header);
  std::vector<std::optional<std::size_t>> found;
  for (const CsvColumn& column : wanted) {
    std::optional<std::size_t> place;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const bool match =
          std::any_of(column.names.begin(), column.names.end(),
                      [&](const std::string& one) {
                        return LowerCase(one) == LowerCase(fields[i]);
                      });
      if (match && place.has_value()) {
        return LineError(name, 1,
                         "names the column " + fields[i] + " more than once");
      }
      if (match) place = i;
    }
    if (!place.has_value() && column.required) {
      return LineError(name, 1,
                       "must name a column " + column.names.front() +
                           ", got \"" + header.substr(0, 60) + "\"");
    }
    found.push_back(place);
  }
  return found;
}

}  // namespace

absl::StatusOr<CsvTable> ReadCsvColumns(std::istream* input,
                                        const std::string& name,
                                        const std::vector<CsvColumn>& wanted) {
  std::string line;
  std::getline(*input, line);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  const auto places = FindColumns(Trimmed(line), name, wanted);
  if (!places.ok()) return places.status();

  CsvTable table;
  table.columns.resize(wanted.size());
  for (std::int64_t number = 2; std::getline(*input, line); ++number) {
    if (line.find_first_not_of(kBlank) == std::string::npos) continue;
    const std::vector<std::string> fields = SplitFields(line);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const std::optional<std::size_t>& place = (*places)[i];
      if (!place.has_value()) continue;
      const std::string text = *place < fields.size() ? fields[*place] : "";
      const std::optional<double> value = ParseNumber(text);
      if (!value.has_value() || !std::isfinite(*value)) {
        return LineError(name, number,
                         "column " + wanted[i].names.front() +
                             " must be a finite number, got \"" +
                             text.substr(0, 60) + "\"");
      }
      table.columns[i].push_back(*value);
    }
    table.lines.push_back(number);
  }
  if (table.lines.empty()) {
    return absl::InvalidArgumentError(name + ": has no row of numbers");
  }
  return table;
}

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
