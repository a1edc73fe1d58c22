#include "core/base/violations.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ViolationsTest, NoneIsOk) {
  const Violations violations;
  EXPECT_TRUE(violations.empty());
  EXPECT_TRUE(violations.ToStatus().ok());
}

TEST(ViolationsTest, StatusCarriesThemInOrder) {
  Violations violations;
  violations.Add("roughness", "must be in (0, 1), got 1.7");
  violations.Add("fidelity", "");
  const absl::Status status = violations.ToStatus();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(std::string(status.message()),
            "roughness: must be in (0, 1), got 1.7; fidelity: ");
  EXPECT_THAT(ViolationsOf(status),
              ElementsAre(Violation{"roughness", "must be in (0, 1), got 1.7"},
                          Violation{"fidelity", ""}));
}

TEST(ViolationsTest, OneViolationMakesAStatus) {
  EXPECT_THAT(ViolationsOf(ViolationError("level", "must be in [0, 40]")),
              ElementsAre(Violation{"level", "must be in [0, 40]"}));
}

TEST(ViolationsTest, OtherStatusesCarryNone) {
  EXPECT_THAT(ViolationsOf(absl::OkStatus()), IsEmpty());
  EXPECT_THAT(ViolationsOf(absl::InvalidArgumentError("no payload")),
              IsEmpty());
}

TEST(ViolationsTest, KeepsTheFirstAndCountsTheRest) {
  Violations violations;
  for (std::size_t i = 0; i < Violations::kKept + 7; ++i) {
    violations.Add("field[" + std::to_string(i) + "]", "bad");
  }
  EXPECT_EQ(violations.kept().size(), Violations::kKept);
  EXPECT_EQ(violations.total(), Violations::kKept + 7);
  const std::vector<Violation> carried = ViolationsOf(violations.ToStatus());
  ASSERT_EQ(carried.size(), Violations::kKept + 1);
  EXPECT_EQ(carried.front().field, "field[0]");
  EXPECT_EQ(carried.back(), (Violation{"(more)", "and 7 more"}));
}

TEST(ViolationsTest, ANulInATextDoesNotBreakTheFraming) {
  Violations violations;
  violations.Add(std::string("a\0b", 3), std::string("\0c", 2));
  violations.Add("d", "e");
  EXPECT_THAT(ViolationsOf(violations.ToStatus()),
              ElementsAre(Violation{"ab", "c"}, Violation{"d", "e"}));
}

}  // namespace
}  // namespace terrane::core
