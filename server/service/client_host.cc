#include "server/service/client_host.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace terrane::server {
namespace {

std::string Text(int family, const void* address) {
  char text[INET6_ADDRSTRLEN] = "";
  inet_ntop(family, address, text, sizeof text);
  return text;
}

}  // namespace

std::optional<std::string> ClientOfAddress(const std::string& address) {
  in_addr four{};
  if (inet_pton(AF_INET, address.c_str(), &four) == 1) {
    return "ipv4:" + Text(AF_INET, &four);
  }
  in6_addr six{};
  if (inet_pton(AF_INET6, address.c_str(), &six) != 1) return std::nullopt;
  if (IN6_IS_ADDR_V4MAPPED(&six)) {
    return "ipv4:" + Text(AF_INET, &six.s6_addr[12]);
  }
  std::fill(std::begin(six.s6_addr) + 8, std::end(six.s6_addr), 0);
  return "ipv6:" + Text(AF_INET6, &six) + "/64";
}

std::string ClientOfPeer(const std::string& peer) {
  const std::size_t scheme = peer.find(':');
  const std::size_t port = peer.rfind(':');
  if (scheme == std::string::npos || scheme == port) return peer;
  std::string_view host(peer);
  host = host.substr(scheme + 1, port - scheme - 1);
  for (const std::string_view bracket : {"%5B", "["}) {
    if (host.starts_with(bracket)) host.remove_prefix(bracket.size());
  }
  for (const std::string_view bracket : {"%5D", "]"}) {
    if (host.ends_with(bracket)) host.remove_suffix(bracket.size());
  }
  return ClientOfAddress(std::string(host)).value_or(peer.substr(0, port));
}

}  // namespace terrane::server
