// The host that a call comes from, as the name of a client.
//
// "ipv4:10.0.0.7", or "ipv6:2001:db8:1:2::/64": whoever has one IPv6 address
// has its whole network of 2^64, and would be as many clients as it likes. An
// IPv4 address in IPv6 form is the IPv4 address. Threads: any.
#ifndef TERRANE_SERVER_SERVICE_CLIENT_HOST_H_
#define TERRANE_SERVER_SERVICE_CLIENT_HOST_H_

#include <optional>
#include <string>

namespace terrane::server {

// Of a numeric address; nothing for anything else.
std::optional<std::string> ClientOfAddress(const std::string& address);

// Of a peer as gRPC says it, "ipv4:10.0.0.7:4711" or "ipv6:%5B::1%5D:4711";
// what is no such thing is a client by that name.
std::string ClientOfPeer(const std::string& peer);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_CLIENT_HOST_H_
