#include "server/service/token_verifier.h"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/sha.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iterator>
#include <jwt/jwt.hpp>
#include <mutex>
#include <optional>
#include <sstream>
#include <unordered_map>

#include "server/actor/error_reason.h"

namespace terrane::server {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kLeewaySeconds = 30;
constexpr int kMinRsaBits = 2048;
constexpr std::size_t kMaxSubjectBytes = 256;

absl::Status KeyError(const std::string& file, const char* problem) {
  ERR_clear_error();
  return absl::InvalidArgumentError("--jwt-key " + file + " " + problem);
}

absl::Status Invalid(const char* problem) {
  return WithReason(
      absl::UnauthenticatedError(std::string("the token ") + problem),
      {std::string(kTokenInvalid), "problem", problem});
}

// The algorithm that goes with a key; empty for a key that will not do.
std::string AlgorithmOf(const EVP_PKEY* key) {
  if (EVP_PKEY_is_a(key, "RSA") == 1) {
    return EVP_PKEY_get_bits(key) >= kMinRsaBits ? "RS256" : "";
  }
  char curve[32] = "";
  std::size_t size = 0;
  if (EVP_PKEY_is_a(key, "EC") == 1 &&
      EVP_PKEY_get_group_name(key, curve, sizeof curve, &size) == 1 &&
      std::string_view(curve, size) == SN_X9_62_prime256v1) {
    return "ES256";
  }
  return "";
}

// Three parts in base64url without padding. cpp-jwt reads outside its tables
// for any other byte.
bool HasForm(std::string_view token) {
  return std::count(token.begin(), token.end(), '.') == 2 &&
         std::all_of(token.begin(), token.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                  (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
         });
}

// RFC 7519: a string, or a list of them.
bool Names(const Json& claim, const std::string& audience) {
  return claim == audience ||
         (claim.is_array() &&
          std::find(claim.begin(), claim.end(), audience) != claim.end());
}

std::string StringOf(const Json& claims, const char* name) {
  const auto claim = claims.find(name);
  return claim != claims.end() && claim->is_string() ? claim->get<std::string>()
                                                     : std::string();
}

// What is wrong with a token that the key has signed; null when it has not.
const char* ProblemOf(const std::error_code& error) {
  if (error == jwt::VerificationErrc::TokenExpired) return "has expired";
  if (error == jwt::VerificationErrc::ImmatureSignature) {
    return "is not valid yet";
  }
  return nullptr;
}

absl::StatusOr<TokenClaims> ReadClaims(const Json& claims,
                                       const TokenOptions& options) {
  const auto expires = claims.find("exp");
  if (expires == claims.end() || !expires->is_number() ||
      expires->get<double>() < 0) {
    return Invalid("has no time of expiry (exp)");
  }
  if (!options.issuer.empty() && StringOf(claims, "iss") != options.issuer) {
    return Invalid("is by another issuer (iss)");
  }
  if (!options.audience.empty() &&
      !Names(claims.value("aud", Json()), options.audience)) {
    return Invalid("is for another audience (aud)");
  }
  TokenClaims result;
  result.expires = expires->get<double>();
  result.subject = StringOf(claims, "sub");
  if (result.subject.empty() || result.subject.size() > kMaxSubjectBytes) {
    return Invalid("has no subject (sub) of 1 to 256 bytes");
  }
  std::istringstream scopes(StringOf(claims, "scope"));
  result.scopes = {std::istream_iterator<std::string>(scopes), {}};
  return result;
}

std::string Digest(std::string_view token) {
  std::string digest(SHA256_DIGEST_LENGTH, '\0');
  SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(),
         reinterpret_cast<unsigned char*>(digest.data()));
  return digest;
}

}  // namespace

// Claims by the digest of their token. Forgets all when it is full.
class TokenVerifier::KnownTokens {
 public:
  std::optional<TokenClaims> Find(const std::string& digest) {
    const double now = std::chrono::duration<double>(
                           std::chrono::system_clock::now().time_since_epoch())
                           .count();
    std::lock_guard lock(mutex_);
    const auto found = claims_.find(digest);
    if (found == claims_.end() || now > found->second.expires) {
      return std::nullopt;
    }
    return found->second;
  }

  void Keep(const std::string& digest, const TokenClaims& claims) {
    std::lock_guard lock(mutex_);
    if (claims_.size() >= kMost) claims_.clear();
    claims_.insert_or_assign(digest, claims);
  }

 private:
  static constexpr std::size_t kMost = 16'384;

  std::mutex mutex_;
  std::unordered_map<std::string, TokenClaims> claims_;
};

TokenVerifier::TokenVerifier(const TokenOptions& options)
    : options_(options), known_(std::make_shared<KnownTokens>()) {}

absl::StatusOr<TokenVerifier::Key> TokenVerifier::LoadKey(
    const std::string& file_name) {
  std::ifstream file(file_name, std::ios::binary);
  std::string pem{std::istreambuf_iterator<char>(file), {}};
  if (!file) return KeyError(file_name, "cannot be read");
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> bio(
      BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())), BIO_free_all);
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(
      PEM_read_bio_PUBKEY(bio.get(), nullptr, nullptr, nullptr), EVP_PKEY_free);
  if (key == nullptr) {
    return KeyError(file_name, "must hold a public key in PEM");
  }
  std::string algorithm = AlgorithmOf(key.get());
  if (algorithm.empty()) {
    return KeyError(file_name,
                    "must be an RSA key of 2048 bits or more (RS256) or "
                    "one on the curve P-256 (ES256)");
  }
  return Key{std::move(pem), std::move(algorithm)};
}

absl::StatusOr<TokenVerifier> TokenVerifier::Load(const TokenOptions& options) {
  TokenVerifier verifier(options);
  for (const std::string& file_name : options.key_files) {
    absl::StatusOr<Key> key = LoadKey(file_name);
    if (!key.ok()) return key.status();
    verifier.keys_.push_back(*std::move(key));
  }
  return verifier;
}

absl::StatusOr<TokenClaims> TokenVerifier::Verify(
    std::string_view token) const {
  const std::string digest = Digest(token);
  if (auto known = known_->Find(digest)) return *std::move(known);
  absl::StatusOr<TokenClaims> claims = Check(token);
  if (claims.ok()) known_->Keep(digest, *claims);
  return claims;
}

absl::StatusOr<TokenClaims> TokenVerifier::Check(std::string_view token) const {
  if (!HasForm(token)) return Invalid("is malformed");
  for (const Key& key : keys_) {
    if (auto claims = CheckWith(key, token)) return *std::move(claims);
  }
  return Invalid("is malformed or signed by no key that is accepted");
}

std::optional<absl::StatusOr<TokenClaims>> TokenVerifier::CheckWith(
    const Key& key, std::string_view token) const {
  try {
    std::error_code error;
    const jwt::jwt_object object = jwt::decode(
        jwt::string_view(token.data(), token.size()),
        jwt::params::algorithms(std::vector<std::string>{key.algorithm}), error,
        jwt::params::secret(key.pem), jwt::params::leeway(kLeewaySeconds),
        jwt::params::verify(true));
    // OpenSSL's errors are the thread's, and gRPC reads them after its own
    // calls.
    ERR_clear_error();
    if (!error) return ReadClaims(object.payload().create_json_obj(), options_);
    const char* const problem = ProblemOf(error);
    if (problem == nullptr) return std::nullopt;
    return Invalid(problem);
  } catch (const std::exception&) {
    // cpp-jwt throws where a part of the token is JSON of another kind.
    ERR_clear_error();
    return std::nullopt;
  }
}

}  // namespace terrane::server
