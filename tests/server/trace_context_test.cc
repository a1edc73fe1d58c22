// The traceparent header, well-formed and not.
#include "server/service/trace_context.h"

#include <gtest/gtest.h>

namespace terrane::server {
namespace {

const std::string kTrace = "4bf92f3577b34da6a3ce929d0e0e4736";
const std::string kParent = "00f067aa0ba902b7";

TEST(TraceContextTest, WellFormedHeadersNameTheirTrace) {
  for (const std::string& header :
       {"00-" + kTrace + "-" + kParent + "-01",
        "00-" + kTrace + "-" + kParent + "-00",
        "cc-" + kTrace + "-" + kParent + "-01",
        "cc-" + kTrace + "-" + kParent + "-01-what"}) {
    EXPECT_EQ(TraceIdOf(header), kTrace) << header;
  }
}

TEST(TraceContextTest, MalformedHeadersNameNone) {
  const std::string zeros(32, '0');
  for (const std::string& header :
       {std::string(), std::string("00"), "00-" + kTrace,
        "00-" + kTrace + "-" + kParent, "00-" + kTrace + "-" + kParent + "-",
        "00-" + kTrace + "-" + kParent + "-1",
        "00-" + kTrace + "-" + kParent + "-0g",
        "00-" + kTrace + "-" + kParent + "-01-what",
        "00-" + kTrace + "-" + kParent + "-01 ",
        "ff-" + kTrace + "-" + kParent + "-01",
        "cc-" + kTrace + "-" + kParent + "-01what",
        "0-" + kTrace + "-" + kParent + "-01",
        "00-" + zeros + "-" + kParent + "-01",
        "00-" + kTrace + "-" + zeros.substr(16) + "-01",
        "00-" + kTrace.substr(1) + "-" + kParent + "-01",
        "00-" + kTrace + "0-" + kParent + "-01",
        "00-4BF92F3577B34DA6A3CE929D0E0E4736-" + kParent + "-01",
        "00-" + kTrace.substr(1) + "\"-" + kParent + "-01"}) {
    EXPECT_EQ(TraceIdOf(header), std::nullopt) << header;
  }
}

}  // namespace
}  // namespace terrane::server
