#include "client/server_address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "absl/status/status.h"

namespace terrane::client {
namespace {

constexpr std::string_view kDns = "dns:///";

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = text.find(',', begin);
    parts.push_back(text.substr(begin, comma - begin));
    if (comma == std::string::npos) return parts;
    begin = comma + 1;
  }
}

struct HostAndPort {
  std::string host;  // without brackets
  std::string port;
};

// Splits "host:port" and "[::1]:port"; an empty host says that it is neither.
HostAndPort Split(std::string_view address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string_view::npos) return {};
  const std::string_view port = address.substr(colon + 1);
  std::string_view host = address.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return {};
  }
  const bool digits =
      !port.empty() && port.size() <= 5 &&
      port.find_first_not_of("0123456789") == std::string_view::npos;
  if (!digits || std::stoi(std::string(port)) > 65535) return {};
  return {std::string(host), std::string(port)};
}

bool IsNumeric(int family, const std::string& host) {
  in6_addr unused;  // large enough for both families
  return inet_pton(family, host.c_str(), &unused) == 1;
}

bool IsLoopback(const std::string& host) {
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && IsNumeric(AF_INET, host));
}

absl::Status NoAddress(const std::string& part) {
  std::string text = "must be HOST:PORT[,HOST:PORT...] or dns:///NAME:PORT";
  text += ", got " + part;
  return absl::InvalidArgumentError(text);
}

// gRPC takes a list only of one family and only of numbers.
absl::StatusOr<std::string> ListTarget(std::vector<HostAndPort> replicas) {
  for (HostAndPort& replica : replicas) {
    if (replica.host == "localhost") replica.host = "127.0.0.1";
  }
  const bool ipv6 = IsNumeric(AF_INET6, replicas.front().host);
  std::string target = ipv6 ? "ipv6:" : "ipv4:";
  for (const HostAndPort& replica : replicas) {
    if (!IsNumeric(ipv6 ? AF_INET6 : AF_INET, replica.host)) {
      return absl::InvalidArgumentError(
          "several servers must be numeric addresses of one family (a name "
          "with several addresses: dns:///NAME:PORT), got " +
          replica.host);
    }
    if (&replica != &replicas.front()) target += ',';
    target += ipv6 ? '[' + replica.host + ']' : replica.host;
    target += ':' + replica.port;
  }
  return target;
}

}  // namespace

absl::StatusOr<ServerAddress> ParseServerAddress(const std::string& text) {
  if (text.starts_with(kDns)) {
    const HostAndPort name = Split(std::string_view(text).substr(kDns.size()));
    if (name.host.empty()) return NoAddress(text);
    return ServerAddress{text, true, IsLoopback(name.host)};
  }
  std::vector<HostAndPort> replicas;
  for (const std::string& part : SplitAtCommas(text)) {
    replicas.push_back(Split(part));
    if (replicas.back().host.empty()) return NoAddress(part);
  }
  const bool loopback = std::all_of(
      replicas.begin(), replicas.end(),
      [](const HostAndPort& replica) { return IsLoopback(replica.host); });
  if (replicas.size() == 1) return ServerAddress{text, false, loopback};
  const absl::StatusOr<std::string> target = ListTarget(replicas);
  if (!target.ok()) return target.status();
  return ServerAddress{*target, true, loopback, true};
}

}  // namespace terrane::client
