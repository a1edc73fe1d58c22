// HttpEndpoint: a few pages over plain HTTP/1.1, for probes and for Prometheus.
//
// No framework of pages, no keep-alive, nothing secret: one thread, one request
// a connection, GET and HEAD. It is to answer while the rest of the process is
// busy or under attack, so everything that a client could hold is bounded: the
// bytes and the time of a request, the time of a reply, the number of
// connections. When all are taken, the oldest makes room for the next one, so
// that clients which send nothing cannot lock a probe out.
//
// Errors: 400 what is not HTTP, 404 no such page, 405 another method, 413 a
// request with content, 431 a header that is too long.
// Threads: pages are made on the endpoint's own thread, one at a time.
#ifndef TERRANE_SERVER_SERVICE_HTTP_ENDPOINT_H_
#define TERRANE_SERVER_SERVICE_HTTP_ENDPOINT_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace terrane::server {

struct HttpReply {
  int status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::string body;
};

// What makes the reply of each path, such as "/livez".
using HttpPages = std::map<std::string, std::function<HttpReply()>>;

struct HttpLimits {
  std::size_t connections = 32;
  std::uint32_t header_bytes = 8 * 1024;
  // For a request to come whole, and again for its reply to go out.
  std::chrono::milliseconds time{5000};
};

class HttpEndpoint {
 public:
  // Serves at once. `listen` is ADDRESS:PORT; port 0 takes a free one. Errors:
  // UNAVAILABLE when it cannot be listened on.
  static absl::StatusOr<std::unique_ptr<HttpEndpoint>> Start(
      const std::string& listen, HttpPages pages, HttpLimits limits = {});
  // Closes what is open.
  ~HttpEndpoint();
  HttpEndpoint(const HttpEndpoint&) = delete;
  HttpEndpoint& operator=(const HttpEndpoint&) = delete;

  // The port that was taken.
  int port() const;

 private:
  class Listener;

  explicit HttpEndpoint(std::unique_ptr<Listener> listener);

  const std::unique_ptr<Listener> listener_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_HTTP_ENDPOINT_H_
