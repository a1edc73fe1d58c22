// Reads Prometheus' text format (version 0.0.4), strictly, for tests.
#ifndef TERRANE_TESTS_SERVER_EXPOSITION_H_
#define TERRANE_TESTS_SERVER_EXPOSITION_H_

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace terrane::server {

class Exposition {
 public:
  explicit Exposition(const std::string& text) {
    static const std::regex kComment("# (HELP|TYPE) ([a-z][a-z0-9_]*) (\\S.*)");
    static const std::regex kSample(
        "([a-z][a-z0-9_]*)(\\{(.*)\\})? (-?[0-9.]+(e[+-]?[0-9]+)?)");
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::smatch part;
      if (std::regex_match(line, part, kComment)) {
        if (part[1] == "TYPE") types_[part[2]] = part[3];
      } else if (std::regex_match(line, part, kSample)) {
        EXPECT_TRUE(types_.contains(FamilyOf(part[1]))) << line;
        const auto [_, is_new] = samples_.emplace(
            std::string(part[1]) + std::string(part[2]), std::stod(part[4]));
        EXPECT_TRUE(is_new) << line;
        ReadLabels(part[1], part[3]);
      } else {
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

  void ReadLabels(const std::string& name, const std::string& list) {
    static const std::regex kLabel("([a-z]+)=\"([^\"]*)\"");
    for (std::sregex_iterator label(list.begin(), list.end(), kLabel), end;
         label != end; ++label) {
      labels_[FamilyOf(name)][(*label)[1]].insert((*label)[2]);
    }
  }

  std::map<std::string, std::string> types_;
  std::map<std::string, double> samples_;
  std::map<std::string, std::map<std::string, std::set<std::string>>> labels_;
};

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_EXPOSITION_H_
