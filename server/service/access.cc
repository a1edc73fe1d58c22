#include "server/service/access.h"

#include <arpa/inet.h>
#include <strings.h>

#include <chrono>
#include <map>
#include <string>
#include <utility>

#include "server/actor/error_reason.h"
#include "server/service/status.h"

namespace terrane::server {
namespace {

constexpr char kRead[] = "terrane.read";
constexpr char kGenerate[] = "terrane.generate";
constexpr char kUpload[] = "terrane.upload";

// How long a client with all its places taken should wait: some of its calls
// will have ended.
constexpr std::chrono::milliseconds kRetryDelay{1000};

const std::map<std::string_view, const char*>& Scopes() {
  static const std::map<std::string_view, const char*> scopes = {
      {"EstimateFlower", kRead},     {"EstimateRender", kRead},
      {"EstimateSurface", kRead},    {"EstimateTiles", kRead},
      {"EstimateTree", kRead},       {"GetFlowerPreset", kRead},
      {"GetHeights", kGenerate},     {"GetPreset", kRead},
      {"GetProfile", kGenerate},     {"GetRaster", kRead},
      {"GetServerInfo", kRead},      {"GetSpotTable", kRead},
      {"GetSurfacePreset", kRead},   {"GetTreePreset", kRead},
      {"PrepareTerrain", kGenerate}, {"StreamFlower", kGenerate},
      {"StreamForest", kGenerate},   {"StreamRender", kGenerate},
      {"StreamSurface", kGenerate},  {"StreamTiles", kGenerate},
      {"StreamTree", kGenerate},     {"StreamTreeLeaves", kGenerate},
      {"StreamTreeMesh", kGenerate}, {"UploadRaster", kUpload},
      {"UploadSpotTable", kUpload},
  };
  return scopes;
}

// The last value of a key of the client's metadata.
std::optional<std::string_view> LastValue(
    const grpc::CallbackServerContext& context, const char* key) {
  const auto& metadata = context.client_metadata();
  auto end = metadata.upper_bound(key);
  if (end == metadata.begin() || (--end)->first != key) return std::nullopt;
  return std::string_view(end->second.data(), end->second.size());
}

// What follows "Bearer", in any case.
std::optional<std::string_view> BearerToken(
    const grpc::CallbackServerContext& context) {
  constexpr std::string_view kScheme = "bearer ";
  if (context.client_metadata().count("authorization") > 1) return std::nullopt;
  const auto value = LastValue(context, "authorization");
  if (!value.has_value() || value->size() <= kScheme.size() ||
      strncasecmp(value->data(), kScheme.data(), kScheme.size()) != 0) {
    return std::nullopt;
  }
  return value->substr(kScheme.size());
}

// "ipv4:10.0.0.7:4711" -> "ipv4:10.0.0.7"
std::string PeerHost(const grpc::CallbackServerContext& context) {
  const std::string peer = context.peer();
  return peer.substr(0, peer.rfind(':'));
}

// The entry that the proxy itself wrote; nothing when it is no address.
std::optional<std::string> ForwardedHost(
    const grpc::CallbackServerContext& context) {
  const auto entries = LastValue(context, "x-forwarded-for");
  if (!entries.has_value()) return std::nullopt;
  const std::size_t start = entries->find_last_of(", ");
  const std::string host(start == entries->npos ? *entries
                                                : entries->substr(start + 1));
  in6_addr address{};
  if (inet_pton(AF_INET, host.c_str(), &address) == 1) return "ipv4:" + host;
  if (inet_pton(AF_INET6, host.c_str(), &address) == 1) return "ipv6:" + host;
  return std::nullopt;
}

absl::Status MissingScope(std::string_view scope) {
  const std::string name(scope);
  return WithReason(
      absl::PermissionDeniedError("the token lacks the scope " + name),
      {std::string(kScopeMissing), "scope", name});
}

}  // namespace

std::optional<std::string_view> ScopeOf(std::string_view method) {
  const auto found = Scopes().find(method);
  if (found == Scopes().end()) return std::nullopt;
  return found->second;
}

Access::Access(const AccessOptions& options)
    : options_(options), places_(options.client_calls) {}

absl::StatusOr<Access> Access::Create(const AccessOptions& options) {
  Access access(options);
  if (options.tokens.on()) {
    auto verifier = TokenVerifier::Load(options.tokens);
    if (!verifier.ok()) return verifier.status();
    access.tokens_ = *std::move(verifier);
  }
  return access;
}

absl::Status Access::Admit(const grpc::CallbackServerContext& context,
                           CallRecord* record) const {
  const absl::Status status = Identify(context, record);
  if (!status.ok() || options_.client_calls == 0) return status;
  record->place = places_.Take(record->client);
  if (record->place != nullptr) return absl::OkStatus();
  record->refusal = Refusal::kClientLimit;
  return WithReason(
      RetryLaterError("the client has " +
                          std::to_string(options_.client_calls) +
                          " calls at a time, the most allowed; try again",
                      kRetryDelay),
      {std::string(kTooManyCalls), "most",
       std::to_string(options_.client_calls)});
}

absl::Status Access::Identify(const grpc::CallbackServerContext& context,
                              CallRecord* record) const {
  record->client = PeerHost(context);
  if (!tokens_.has_value()) {
    if (options_.trust_forwarded_for) {
      record->client = ForwardedHost(context).value_or(record->client);
    }
    return absl::OkStatus();
  }
  const auto token = BearerToken(context);
  if (!token.has_value()) {
    return WithReason(
        absl::UnauthenticatedError("the call must bring one bearer token"),
        {std::string(kTokenMissing), "header", "authorization"});
  }
  const auto claims = tokens_->Verify(*token);
  if (!claims.ok()) return claims.status();
  record->client = "sub:" + claims->subject;
  const auto scope = ScopeOf(record->method);
  if (!scope.has_value()) return MissingScope("of an unknown method");
  if (!claims->scopes.contains(std::string(*scope))) {
    return MissingScope(*scope);
  }
  return absl::OkStatus();
}

}  // namespace terrane::server
