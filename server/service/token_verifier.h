// TokenVerifier: who a bearer token (JWT, RFC 7519) speaks for, and what it
// allows.
//
// Every public key has one algorithm: RS256 for an RSA key of at least 2048
// bits, ES256 for a key on P-256. What a token's header claims (none, an HMAC
// keyed with the public key) never chooses another. The signature is checked by
// cpp-jwt and OpenSSL, with one key after the other: while an issuer changes
// its key there are two.
//
// A token must have `exp` in the future, `nbf` not in it if there, both by the
// system clock give or take 30 s; `sub`; `iss` and `aud` when asked for; its
// scopes are the words of `scope`.
//
// A check takes cpp-jwt near a millisecond, most of it to read the key anew,
// and the calls of a client bring the same token. So good ones are known again
// by their SHA-256 until they expire.
//
// Threads: Verify from any. Errors: UNAUTHENTICATED with the reason
// TOKEN_INVALID. No error holds anything of the token.
#ifndef TERRANE_SERVER_SERVICE_TOKEN_VERIFIER_H_
#define TERRANE_SERVER_SERVICE_TOKEN_VERIFIER_H_

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace terrane::server {

inline constexpr std::string_view kTokenInvalid = "TOKEN_INVALID";

struct TokenOptions {
  // A public key in PEM each; empty: no tokens are asked for.
  std::vector<std::string> key_files;
  // Who must have made the token, and for whom; empty: anybody.
  std::string issuer;
  std::string audience;

  bool on() const { return !key_files.empty(); }
};

// What a token says.
struct TokenClaims {
  std::string subject;
  std::set<std::string> scopes;
  double expires = 0;  // seconds since 1970
};

class TokenVerifier {
 public:
  // Errors: INVALID_ARGUMENT naming the flag, when a file cannot be read or
  // holds another kind of key.
  static absl::StatusOr<TokenVerifier> Load(const TokenOptions& options);

  absl::StatusOr<TokenClaims> Verify(std::string_view token) const;

 private:
  class KnownTokens;
  struct Key {
    std::string pem;
    std::string algorithm;
  };

  explicit TokenVerifier(const TokenOptions& options);

  static absl::StatusOr<Key> LoadKey(const std::string& file_name);
  absl::StatusOr<TokenClaims> Check(std::string_view token) const;
  // Nothing when the key did not sign the token.
  std::optional<absl::StatusOr<TokenClaims>> CheckWith(
      const Key& key, std::string_view token) const;

  TokenOptions options_;
  std::vector<Key> keys_;
  std::shared_ptr<KnownTokens> known_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_TOKEN_VERIFIER_H_
