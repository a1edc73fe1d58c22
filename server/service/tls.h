// The server's credentials: TLS from files, or plain HTTP/2.
//
// At least TLS 1.2. The files are looked at again while the server runs, and
// new connections get what they hold then; open ones keep theirs. Certificate
// and key belong together, so both are to be replaced at once, each by a
// rename: a pair that does not match fails every handshake until it does.
#ifndef TERRANE_SERVER_SERVICE_TLS_H_
#define TERRANE_SERVER_SERVICE_TLS_H_

#include <grpcpp/security/server_credentials.h>

#include <chrono>
#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace terrane::server {

// Names of PEM files. Without a certificate there is no TLS.
struct TlsFiles {
  std::string certificate;  // the chain, the server's own first
  std::string key;
  // Of the clients' certificates, which are demanded then.
  std::string client_ca;
  // How often the files are looked at.
  std::chrono::seconds refresh{10};

  bool on() const { return !certificate.empty(); }
};

// Errors: INVALID_ARGUMENT naming the flag whose file cannot be read or is of
// another kind, or a key that is not the certificate's.
absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeServerCredentials(
    const TlsFiles& files);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_TLS_H_
