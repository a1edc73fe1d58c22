// Recipes and requests written as protobuf JSON, for tests.
#ifndef TERRANE_TESTS_SERVER_RECIPE_TEXT_H_
#define TERRANE_TESTS_SERVER_RECIPE_TEXT_H_

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <string>

namespace terrane::server {

template <typename Message>
Message FromJson(const std::string& json) {
  Message message;
  const auto parsed =
      google::protobuf::util::JsonStringToMessage(json, &message);
  EXPECT_TRUE(parsed.ok()) << parsed.ToString() << " in " << json;
  return message;
}

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_RECIPE_TEXT_H_
