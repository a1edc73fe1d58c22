// Reads Prometheus' text format (version 0.0.4), strictly, for tests.
#ifndef TERRANE_TESTS_SERVER_EXPOSITION_H_
#define TERRANE_TESTS_SERVER_EXPOSITION_H_

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <set>
#include <sstream>
#include <string>

namespace terrane::server {

class Exposition {
 public:
  explicit Exposition(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (!(line.starts_with("# ") ? ReadComment(line) : ReadSample(line))) {
        ADD_FAILURE() << "not a line of the text format: " << line;
      }
    }
    EXPECT_TRUE(text.ends_with('\n'));
  }

  // Of a series such as "terrane_rpc_total{code=\"OK\",method=\"GetPreset\"}";
  // -1 when it is not there. Labels come in the order of their names.
  double operator[](const std::string& series) const {
    const auto found = samples_.find(series);
    return found == samples_.end() ? -1 : found->second;
  }
  bool Has(const std::string& family) const { return types_.contains(family); }
  // "counter", "gauge" or "histogram" by the name of the metric.
  const std::map<std::string, std::string>& types() const { return types_; }
  const std::map<std::string, double>& samples() const { return samples_; }
  // Every label of a family, and its values.
  std::map<std::string, std::set<std::string>> Labels(
      const std::string& family) const {
    const auto found = labels_.find(family);
    return found == labels_.end()
               ? std::map<std::string, std::set<std::string>>()
               : found->second;
  }

 private:
  // The parts of a histogram belong to its family.
  std::string FamilyOf(const std::string& name) const {
    for (const std::string ending : {"_bucket", "_sum", "_count"}) {
      if (!name.ends_with(ending)) continue;
      const std::string family = name.substr(0, name.size() - ending.size());
      const auto type = types_.find(family);
      if (type != types_.end() && type->second == "histogram") return family;
    }
    return name;
  }

  static bool IsName(const std::string& text) {
    return !text.empty() && text[0] >= 'a' && text[0] <= 'z' &&
           text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") ==
               text.npos;
  }

  // "# HELP name text" or "# TYPE name type".
  bool ReadComment(const std::string& line) {
    std::istringstream words(line);
    std::string hash;
    std::string kind;
    std::string name;
    std::string rest;
    words >> hash >> kind >> name >> rest;
    if (kind == "TYPE") types_[name] = rest;
    return (kind == "HELP" || kind == "TYPE") && IsName(name) && !rest.empty();
  }

  // "name value" or "name{label="value",...} value".
  bool ReadSample(const std::string& line) {
    const std::size_t space = line.rfind(' ');
    if (space == line.npos) return false;
    const std::string series = line.substr(0, space);
    const std::string number = line.substr(space + 1);
    std::size_t read = 0;
    const double value = number.empty() ? 0 : std::stod(number, &read);
    const std::size_t brace = series.find('{');
    const std::string name = series.substr(0, brace);
    if (read != number.size() || number.empty() || !IsName(name)) return false;
    EXPECT_TRUE(types_.contains(FamilyOf(name))) << line;
    EXPECT_TRUE(samples_.emplace(series, value).second) << line;
    if (brace == series.npos) return true;
    return series.ends_with('}') &&
           ReadLabels(FamilyOf(name),
                      series.substr(brace + 1, series.size() - brace - 2));
  }

  // "label="value",label="value"".
  bool ReadLabels(const std::string& family, const std::string& list) {
    for (std::size_t at = 0; at < list.size();) {
      const std::size_t equals = list.find("=\"", at);
      const std::size_t end =
          equals == list.npos ? equals : list.find('"', equals + 2);
      if (end == list.npos) return false;
      labels_[family][list.substr(at, equals - at)].insert(
          list.substr(equals + 2, end - equals - 2));
      if (end + 1 < list.size() && list[end + 1] != ',') return false;
      at = end + 2;
    }
    return true;
  }

  std::map<std::string, std::string> types_;
  std::map<std::string, double> samples_;
  std::map<std::string, std::map<std::string, std::set<std::string>>> labels_;
};

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_EXPOSITION_H_
