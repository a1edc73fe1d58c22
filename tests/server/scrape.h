// What the metrics of a Served say, for tests that wait for it.
#ifndef TERRANE_TESTS_SERVER_SCRAPE_H_
#define TERRANE_TESTS_SERVER_SCRAPE_H_

#include <string>

#include "tests/server/exposition.h"
#include "tests/server/fake_actor.h"
#include "tests/server/http_exchange.h"
#include "tests/server/served.h"

namespace terrane::server {

inline ServerOptions WithHttp() {
  ServerOptions options;
  options.http_listen = "127.0.0.1:0";
  return options;
}

// The server was started WithHttp.
inline Exposition Scrape(Served* served) {
  return Exposition(
      HttpBody(HttpGet(*served->server().http_port(), "/metrics")));
}

inline double Calls(const Exposition& text, const std::string& method,
                    const std::string& code) {
  return text["terrane_rpc_total{code=\"" + code + "\",method=\"" + method +
              "\"}"];
}

// A call is counted a moment after its client has the answer.
template <typename Condition>
bool EventuallyScraped(Served* served, Condition condition) {
  return Eventually([&] { return condition(Scrape(served)); });
}

}  // namespace terrane::server

#endif  // TERRANE_TESTS_SERVER_SCRAPE_H_
