#include "server/service/access.h"

#include <strings.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/actor/error_reason.h"
#include "server/service/client_host.h"
#include "server/service/status.h"

namespace terrane::server {
namespace {

constexpr std::string_view kRead = "terrane.read";
constexpr std::string_view kGenerate = kGenerateScope;
constexpr std::string_view kUpload = "terrane.upload";

using Clock = std::chrono::steady_clock;
using Seconds = ClientAccounts::Seconds;

// How long a client with all its places taken should wait: some of its calls
// will have ended.
constexpr Seconds kPlaceDelay{1};

const std::map<std::string_view, std::string_view>& Scopes() {
  static const std::map<std::string_view, std::string_view> scopes = {
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

// Whom the certificate of the peer names first, by alternative name or else by
// common name; nothing without a certificate that was checked.
std::optional<std::string> CertifiedName(
    const grpc::CallbackServerContext& context) {
  const auto peer = context.auth_context();
  if (peer == nullptr || !peer->IsPeerAuthenticated()) return std::nullopt;
  const std::vector<grpc::string_ref> names = peer->GetPeerIdentity();
  if (names.empty()) return std::nullopt;
  return "cert:" + std::string(names[0].data(), names[0].size());
}

// The entry that the proxy itself wrote; nothing when it is no address.
std::optional<std::string> ForwardedHost(
    const grpc::CallbackServerContext& context) {
  const auto entries = LastValue(context, "x-forwarded-for");
  if (!entries.has_value()) return std::nullopt;
  const std::size_t start = entries->find_last_of(", ");
  return ClientOfAddress(std::string(
      start == entries->npos ? *entries : entries->substr(start + 1)));
}

absl::Status MissingScope(std::string_view scope) {
  const std::string name(scope);
  return WithReason(
      absl::PermissionDeniedError("the token lacks the scope " + name),
      {std::string(kScopeMissing), "scope", name});
}

std::unique_ptr<ClientAccounts> AccountsOf(double per_second) {
  return per_second > 0 ? std::make_unique<ClientAccounts>(per_second)
                        : nullptr;
}

// The client has as much of `what` as it may have.
absl::Status Exceeded(std::string_view reason, const char* what, double most,
                      Seconds wait) {
  char number[32];
  std::snprintf(number, sizeof number, "%g", most);
  char text[128];
  std::snprintf(text, sizeof text,
                "the client has reached its limit, %s: %s; try again in %.1f s",
                what, number, wait.count());
  return WithReason(
      RetryLaterError(text, std::chrono::ceil<std::chrono::milliseconds>(wait)),
      {std::string(reason), "most", number});
}

// OK while the client's account holds something, and where there is no limit.
absl::Status CheckAccount(const ClientAccounts* accounts,
                          const std::string& client, std::string_view reason,
                          const char* what) {
  if (accounts == nullptr) return absl::OkStatus();
  const Seconds wait = accounts->Wait(client, Clock::now());
  if (wait <= Seconds(0)) return absl::OkStatus();
  return Exceeded(reason, what, accounts->per_second(), wait);
}

}  // namespace

std::optional<std::string_view> ScopeOf(std::string_view method) {
  const auto found = Scopes().find(method);
  if (found == Scopes().end()) return std::nullopt;
  return found->second;
}

Access::Access(const AccessOptions& options)
    : options_(options),
      places_(options.client_calls),
      calls_(AccountsOf(options.client_rate)),
      work_(AccountsOf(options.client_workers)) {}

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
  if (absl::Status status = Identify(context, record); !status.ok()) {
    return status;
  }
  absl::Status status = CheckLimits(record);
  if (!status.ok()) {
    record->refusal = Refusal::kClientLimit;
  } else if (calls_ != nullptr) {
    // Only of calls that are taken: who was told to wait may come back.
    calls_->Charge(record->client, 1, Clock::now());
  }
  return status;
}

absl::Status Access::CheckLimits(CallRecord* record) const {
  absl::Status status = CheckAccount(calls_.get(), record->client,
                                     kCallRateExceeded, "calls a second");
  if (!status.ok()) return status;
  status = CheckAccount(work_.get(), record->client, kWorkRateExceeded,
                        "workers kept busy");
  if (!status.ok()) return status;
  if (options_.client_calls == 0) return absl::OkStatus();
  record->place = places_.Take(record->client);
  if (record->place != nullptr) return absl::OkStatus();
  return Exceeded(kTooManyCalls, "calls at a time", options_.client_calls,
                  kPlaceDelay);
}

void Access::Settle(const CallRecord& record) const {
  if (calls_ != nullptr && record.refusal.has_value() &&
      record.refusal != Refusal::kClientLimit) {
    calls_->Charge(record.client, -1, Clock::now());
  }
  if (work_ == nullptr || record.generated.count() == 0) return;
  work_->Charge(record.client, Seconds(record.generated).count(), Clock::now());
}

absl::Status Access::Identify(const grpc::CallbackServerContext& context,
                              CallRecord* record) const {
  record->client =
      CertifiedName(context).value_or(ClientOfPeer(context.peer()));
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
