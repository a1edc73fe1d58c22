// What --server names: one server, several replicas, or a name with an address
// for each of them.
//
//   HOST:PORT                 one server
//   HOST:PORT,HOST:PORT,...   replicas: numeric addresses of one family, or
//                             localhost
//   dns:///NAME:PORT          every address that NAME has, such as those of a
//                             headless service
//
// Calls to replicas go round robin, and past those that do not answer; answers
// are the same bytes on each, so a cut stream goes on at another one. Pure
// functions of the text.
#ifndef TERRANE_CLIENT_SERVER_ADDRESS_H_
#define TERRANE_CLIENT_SERVER_ADDRESS_H_

#include <string>

#include "absl/status/statusor.h"

namespace terrane::client {

struct ServerAddress {
  // As gRPC dials it: "127.0.0.1:50051", "ipv4:10.0.0.1:7400,10.0.0.2:7400".
  std::string target;
  // Calls are spread over what the target resolves to.
  bool several = false;
  // Every address is this machine's own.
  bool loopback = false;
  // A list has no one host that certificates could be checked against.
  bool list = false;
};

// INVALID_ARGUMENT names the part that is no address.
absl::StatusOr<ServerAddress> ParseServerAddress(const std::string& text);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SERVER_ADDRESS_H_
