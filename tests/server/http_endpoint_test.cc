// The plain HTTP port: what it answers, and that no client can hold it.
#include "server/service/http_endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <memory>
#include <vector>

#include "tests/server/fake_actor.h"
#include "tests/server/http_exchange.h"

namespace terrane::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class HttpEndpointTest : public ::testing::Test {
 protected:
  static HttpPages Pages() {
    return {
        {"/hello", [] { return HttpReply{.body = "hello\n"}; }},
        {"/json",
         [] {
           return HttpReply{.content_type = "application/json", .body = "{}"};
         }},
        {"/busy", [] { return HttpReply{.status = 503, .body = "busy\n"}; }},
        {"/large",
         [] { return HttpReply{.body = std::string(32 << 20, 'x')}; }}};
  }
  // Of this process.
  static std::ptrdiff_t OpenFiles() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                         std::filesystem::directory_iterator());
  }
  std::unique_ptr<HttpEndpoint> Start(HttpLimits limits = {}) {
    auto endpoint = HttpEndpoint::Start("127.0.0.1:0", Pages(), limits);
    EXPECT_TRUE(endpoint.ok()) << endpoint.status();
    return *std::move(endpoint);
  }
};

TEST_F(HttpEndpointTest, PagesAreAnswered) {
  const auto endpoint = Start();
  EXPECT_THAT(
      HttpGet(endpoint->port(), "/hello"),
      AllOf(StartsWith("HTTP/1.1 200 OK\r\n"),
            HasSubstr("Content-Type: text/plain; charset=utf-8\r\n"),
            HasSubstr("Content-Length: 6\r\n"),
            HasSubstr("Connection: close\r\n"), EndsWith("\r\n\r\nhello\n")));
  EXPECT_THAT(HttpGet(endpoint->port(), "/json"),
              AllOf(HasSubstr("Content-Type: application/json\r\n"),
                    EndsWith("\r\n\r\n{}")));
  EXPECT_THAT(HttpGet(endpoint->port(), "/busy"),
              StartsWith("HTTP/1.1 503 Service Unavailable\r\n"));
  EXPECT_THAT(HttpGet(endpoint->port(), "/hello?at=1"),
              EndsWith("\r\n\r\nhello\n"));
  EXPECT_EQ(HttpBody(HttpGet(endpoint->port(), "/large")).size(), 32U << 20);
}

TEST_F(HttpEndpointTest, HeadHasTheHeaderOnly) {
  const auto endpoint = Start();
  EXPECT_THAT(
      HttpExchange(endpoint->port(), "HEAD /hello HTTP/1.1\r\nHost: a\r\n\r\n"),
      AllOf(StartsWith("HTTP/1.1 200 OK\r\n"),
            HasSubstr("Content-Length: 6\r\n"), EndsWith("\r\n\r\n")));
}

TEST_F(HttpEndpointTest, WhatItDoesNotHaveIsRefused) {
  const auto endpoint = Start();
  EXPECT_THAT(HttpGet(endpoint->port(), "/nothing"),
              StartsWith("HTTP/1.1 404 Not Found\r\n"));
  EXPECT_THAT(HttpGet(endpoint->port(), "/hello/../../etc"),
              StartsWith("HTTP/1.1 404 Not Found\r\n"));
  EXPECT_THAT(HttpExchange(endpoint->port(),
                           "DELETE /hello HTTP/1.1\r\nHost: a\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 405 Method Not Allowed\r\n"),
                    HasSubstr("Allow: GET, HEAD\r\n")));
  EXPECT_THAT(
      HttpExchange(endpoint->port(), "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"),
      StartsWith("HTTP/1.1 400 Bad Request\r\n"));
  EXPECT_THAT(HttpExchange(endpoint->port(), "\x16\x03\x01\r\n\r\n"),
              StartsWith("HTTP/1.1 400 Bad Request\r\n"));
}

TEST_F(HttpEndpointTest, LargeRequestsAreRefused) {
  const auto endpoint = Start();
  const std::string line = "GET /hello HTTP/1.1\r\nHost: a\r\n";
  EXPECT_THAT(
      HttpExchange(endpoint->port(),
                   line + "X-Long: " + std::string(20'000, 'x') + "\r\n\r\n"),
      StartsWith("HTTP/1.1 431 "));
  EXPECT_THAT(HttpExchange(endpoint->port(), line + "Content-Length: 5\r\n\r\n"
                                                    "12345"),
              StartsWith("HTTP/1.1 413 "));
  EXPECT_THAT(
      HttpExchange(endpoint->port(),
                   line + "Transfer-Encoding: chunked\r\n\r\n5\r\n12345\r\n"),
      StartsWith("HTTP/1.1 413 "));
}

// A client that has nothing to say is left after the time of a request, and so
// is one that sends a byte now and then.
TEST_F(HttpEndpointTest, SlowRequestsAreCut) {
  const auto endpoint = Start({.time = milliseconds(300)});
  const TcpClient silent(endpoint->port());
  const TcpClient trickling(endpoint->port());
  ASSERT_TRUE(trickling.Send("GET /hello HTTP/1.1\r\nX-Slow: "));
  EXPECT_TRUE(Eventually([&] { return !trickling.Send("x"); }));
  EXPECT_THAT(silent.ReadToEnd(), IsEmpty());
}

TEST_F(HttpEndpointTest, SlowReadersAreCut) {
  const auto endpoint = Start({.time = milliseconds(300)});
  const std::ptrdiff_t files_before = OpenFiles();
  const TcpClient client(endpoint->port());
  ASSERT_TRUE(client.Send("GET /large HTTP/1.1\r\nHost: a\r\n\r\n"));
  client.AwaitReply();
  // The client's end is left, the server's is closed.
  EXPECT_TRUE(Eventually([&] { return OpenFiles() == files_before + 1; }));
  EXPECT_LT(client.ReadToEnd().size(), 32U << 20);
}

TEST_F(HttpEndpointTest, SilentConnectionsLockNobodyOut) {
  const auto endpoint = Start({.connections = 4, .time = minutes(1)});
  std::vector<std::unique_ptr<TcpClient>> silent;
  for (int i = 0; i < 20; ++i) {
    silent.push_back(std::make_unique<TcpClient>(endpoint->port()));
    silent.back()->Send("GET /he");
  }
  EXPECT_THAT(HttpGet(endpoint->port(), "/hello"), EndsWith("hello\n"));
  // The oldest made room.
  EXPECT_THAT(silent.front()->ReadToEnd(), IsEmpty());
  // The latest may still finish.
  silent.back()->Send("llo HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_THAT(silent.back()->ReadToEnd(), EndsWith("hello\n"));
}

TEST_F(HttpEndpointTest, EndsWithConnectionsOpen) {
  auto endpoint = Start();
  const TcpClient silent(endpoint->port());
  EXPECT_THAT(HttpGet(endpoint->port(), "/hello"), EndsWith("hello\n"));
  endpoint.reset();
  EXPECT_THAT(silent.ReadToEnd(), IsEmpty());
}

TEST_F(HttpEndpointTest, AddressesThatCannotBeHad) {
  const auto endpoint = Start();
  const std::string taken = "127.0.0.1:" + std::to_string(endpoint->port());
  const auto second = HttpEndpoint::Start(taken, Pages());
  EXPECT_EQ(second.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(second.status().message()),
              StartsWith("cannot listen on " + taken + ": "));
  EXPECT_EQ(HttpEndpoint::Start("no such host:0", Pages()).status().code(),
            absl::StatusCode::kUnavailable);
  // Not every machine has the loopback address of version 6.
  EXPECT_THAT(HttpEndpoint::Start("[::1]:0", Pages()).status().ToString(),
              AnyOf("OK", HasSubstr("Cannot assign requested address")));
}

}  // namespace
}  // namespace terrane::server
