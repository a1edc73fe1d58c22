// Runs read to their end, for tests.
#ifndef TERRANE_TESTS_SERVER_READ_ALL_H_
#define TERRANE_TESTS_SERVER_READ_ALL_H_

#include <gtest/gtest.h>

#include <vector>

#include "server/actor/message_run.h"

namespace terrane::server {

// Every message of a run; the first is the header.
template <typename Message>
std::vector<Message> ReadAll(OpenedRun<Message> run) {
  std::vector<Message> messages;
  EXPECT_TRUE(run.ok()) << run.status();
  while (run.ok() && !(*run)->Done()) {
    const absl::Status status = (*run)->Next({}, &messages.emplace_back());
    EXPECT_TRUE(status.ok()) << status;
    if (!status.ok()) break;
  }
  return messages;
}

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_READ_ALL_H_
