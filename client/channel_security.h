// What secures the connection to a server.
#ifndef TERRANE_CLIENT_CHANNEL_SECURITY_H_
#define TERRANE_CLIENT_CHANNEL_SECURITY_H_

#include <string>

namespace terrane::client {

// Empty: none. `ca`, `certificate` and `key` are PEM files.
struct ChannelSecurity {
  bool tls = false;
  std::string ca;           // who signs servers; none: whom the system trusts
  std::string name;         // in their certificates; none: the address's host
  std::string certificate;  // this client's own, for servers that demand one
  std::string key;
  // A file with a bearer token, read anew for every call, so that a long run
  // outlives it.
  std::string token;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_CHANNEL_SECURITY_H_
