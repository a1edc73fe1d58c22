// Access: who a call is from, and whether it may be made.
//
// Every call begins here (BeginCall, call_context.h). Its client is the subject
// of its token ("sub:alice"), where tokens are asked for; else the host that a
// trusted proxy names; else who its certificate says ("cert:alice"), where
// certificates are asked for; else the host it comes from (client_host.h). A
// client may be held to so many calls at a time and a second, and to so much of
// the workers. Health checks, and reflection where it is on, are gRPC's own
// services and open to all.
//
// Threads: any.
#ifndef TERRANE_SERVER_SERVICE_ACCESS_H_
#define TERRANE_SERVER_SERVICE_ACCESS_H_

#include <grpcpp/server_context.h>

#include <memory>
#include <optional>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/service/call_log.h"
#include "server/service/client_accounts.h"
#include "server/service/client_places.h"
#include "server/service/token_verifier.h"

namespace terrane::server {

// The scope that a method takes, as it stands in tokens: terrane.read for what
// only looks something up, terrane.generate for what computes, terrane.upload
// for what is kept. Nothing for an unknown method, which nobody may call.
std::optional<std::string_view> ScopeOf(std::string_view method);

inline constexpr std::string_view kGenerateScope = "terrane.generate";

inline constexpr std::string_view kTokenMissing = "TOKEN_MISSING";
inline constexpr std::string_view kScopeMissing = "SCOPE_MISSING";
inline constexpr std::string_view kTooManyCalls = "TOO_MANY_CALLS";
inline constexpr std::string_view kCallRateExceeded = "CALL_RATE_EXCEEDED";
inline constexpr std::string_view kWorkRateExceeded = "WORK_RATE_EXCEEDED";

struct AccessOptions {
  TokenOptions tokens;
  // A client without a token is the last address of x-forwarded-for. For a
  // server that only a proxy reaches: anybody else could write anything there.
  bool trust_forwarded_for = false;
  // Of one client; 0: any number.
  int client_calls = 0;       // at a time
  double client_rate = 0;     // calls a second, in the long run
  double client_workers = 0;  // workers' seconds a second, in the long run
};

class Access {
 public:
  // Errors: as TokenVerifier::Load.
  static absl::StatusOr<Access> Create(const AccessOptions& options);

  // Fills in the client of `record`, whose method is set, and its place.
  // Errors: UNAUTHENTICATED (TOKEN_MISSING, TOKEN_INVALID), PERMISSION_DENIED
  // (SCOPE_MISSING), RESOURCE_EXHAUSTED (TOO_MANY_CALLS, CALL_RATE_EXCEEDED,
  // WORK_RATE_EXCEEDED).
  absl::Status Admit(const grpc::CallbackServerContext& context,
                     CallRecord* record) const;
  // The call is over: its client pays for what it took, and has back what it
  // paid for a call that was refused after all.
  void Settle(const CallRecord& record) const;

 private:
  explicit Access(const AccessOptions& options);

  absl::Status Identify(const grpc::CallbackServerContext& context,
                        CallRecord* record) const;
  // Whether the client has something left of all that it may have, and its
  // place.
  absl::Status CheckLimits(CallRecord* record) const;

  AccessOptions options_;
  std::optional<TokenVerifier> tokens_;
  mutable ClientPlaces places_;
  // Null where there is no limit.
  std::unique_ptr<ClientAccounts> calls_;
  std::unique_ptr<ClientAccounts> work_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_ACCESS_H_
