// One rule of a TerrainSpec for table-driven tests: what breaks it, the field
// that is named and what is said of it.
#ifndef TERRANE_TESTS_CORE_VALIDATE_RULE_H_
#define TERRANE_TESTS_CORE_VALIDATE_RULE_H_

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/terrain/validate.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Rule {
  std::string name;
  std::function<void(TerrainSpec*)> breaks;
  std::string field;
  std::string description;
};

inline std::string RuleName(const ::testing::TestParamInfo<Rule>& info) {
  return info.param.name;
}

inline std::vector<Violation> Validate(const TerrainSpec& spec,
                                       const SpecLimits& limits = {}) {
  Violations violations;
  ValidateSpec(spec, limits, "", &violations);
  return violations.kept();
}

// The fields that are named, in their order.
inline std::vector<std::string> FieldsOf(const TerrainSpec& spec) {
  std::vector<std::string> fields;
  for (const Violation& one : Validate(spec)) fields.push_back(one.field);
  return fields;
}

// Breaking the rule makes one violation: of its field, with its description.
inline void ExpectViolation(const Rule& rule) {
  using ::testing::Field;
  TerrainSpec spec;
  rule.breaks(&spec);
  EXPECT_THAT(Validate(spec),
              ::testing::ElementsAre(::testing::AllOf(
                  Field(&Violation::field, rule.field),
                  Field(&Violation::description,
                        ::testing::HasSubstr(rule.description)))));
}

inline std::shared_ptr<const Raster> MakeRaster(std::int64_t width,
                                                std::int64_t height) {
  auto raster = std::make_shared<Raster>();
  raster->width = width;
  raster->height = height;
  raster->frame = {100, 200, 10, -10};
  raster->values.resize(static_cast<std::size_t>(width * height), 1.0f);
  return raster;
}

inline void AddPart(TerrainSpec* spec, decltype(MacroPart::shape) shape) {
  spec->macro.parts.push_back({MacroCombine::kAdd, std::move(shape)});
}

inline ControlNet FlatNet(int columns, int rows) {
  ControlNet net;
  net.columns = columns;
  net.rows = rows;
  net.heights.resize(static_cast<std::size_t>(columns * rows));
  net.maximum = {1, 1};
  return net;
}

}  // namespace terrane::core

#endif  // TERRANE_TESTS_CORE_VALIDATE_RULE_H_
