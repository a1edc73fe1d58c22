#include "client/channel.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <grpcpp/support/client_interceptor.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include "client/server_address.h"

namespace terrane::client {
namespace {

// A tile of the largest size is just over gRPC's default of 4 MiB.
constexpr int kMaxMessageBytes = 64 << 20;

using grpc::experimental::ClientInterceptorFactoryInterface;
using grpc::experimental::ClientRpcInfo;
using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::Interceptor;
using grpc::experimental::InterceptorBatchMethods;

absl::StatusOr<std::string> ReadFile(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (!file) return absl::InvalidArgumentError("cannot read " + name);
  return content;
}

absl::StatusOr<std::string> ReadToken(const std::string& name) {
  absl::StatusOr<std::string> token = ReadFile(name);
  if (!token.ok()) return token;
  token->erase(token->find_last_not_of(" \r\n") + 1);
  const bool good = !token->empty() &&
                    std::all_of(token->begin(), token->end(),
                                [](char c) { return c > ' ' && c <= '~'; });
  if (!good) {
    return absl::InvalidArgumentError(name + " must hold one token");
  }
  return token;
}

// The token of a file that others replace from time to time. Threads: any.
class TokenFile {
 public:
  TokenFile(std::string name, std::string token)
      : name_(std::move(name)), token_(std::move(token)) {}

  // The one before while the file is being replaced: the server knows how long
  // it holds.
  std::string Token() {
    std::lock_guard lock(mutex_);
    if (auto token = ReadToken(name_); token.ok()) token_ = *std::move(token);
    return token_;
  }

 private:
  const std::string name_;
  std::mutex mutex_;
  std::string token_;
};

// Adds the token to a call. An interceptor, since call credentials do not go
// with a channel that has no TLS.
class TokenAdder : public Interceptor {
 public:
  explicit TokenAdder(std::string token) : token_(std::move(token)) {}

  void Intercept(InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(
            InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      methods->GetSendInitialMetadata()->emplace("authorization",
                                                 "Bearer " + token_);
    }
    methods->Proceed();
  }

 private:
  const std::string token_;
};

class TokenAdderFactory : public ClientInterceptorFactoryInterface {
 public:
  explicit TokenAdderFactory(std::shared_ptr<TokenFile> file)
      : file_(std::move(file)) {}

  // gRPC owns what it gets.
  Interceptor* CreateClientInterceptor(ClientRpcInfo*) override {
    return new TokenAdder(file_->Token());
  }

 private:
  const std::shared_ptr<TokenFile> file_;
};

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> Credentials(
    const ChannelSecurity& security) {
  if (!security.tls) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions options;
  const std::pair<const std::string&, std::string&> files[] = {
      {security.ca, options.pem_root_certs},
      {security.certificate, options.pem_cert_chain},
      {security.key, options.pem_private_key}};
  for (const auto& [name, pem] : files) {
    if (name.empty()) continue;
    absl::StatusOr<std::string> content = ReadFile(name);
    if (!content.ok()) return content.status();
    pem = *std::move(content);
  }
  return grpc::SslCredentials(options);
}

// A machine that vanished must not keep its streams for ever.
void AskWhetherAlive(std::chrono::milliseconds ping_after,
                     grpc::ChannelArguments* arguments) {
  const int ms = static_cast<int>(ping_after.count());
  arguments->SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, ms);
  arguments->SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, ms);
  // Else gRPC stops to ask on a stream on which nothing else goes.
  arguments->SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
}

grpc::ChannelArguments Arguments(const ServerAddress& address,
                                 const ChannelSecurity& security,
                                 ChannelKind kind,
                                 std::chrono::milliseconds ping_after) {
  grpc::ChannelArguments arguments;
  // A proxy of the environment is the way to other machines.
  if (address.loopback) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  if (address.several) arguments.SetLoadBalancingPolicyName("round_robin");
  if (kind == ChannelKind::kOwnConnection) {
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  }
  arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
  if (!security.name.empty()) {
    arguments.SetSslTargetNameOverride(security.name);
  }
  AskWhetherAlive(ping_after, &arguments);
  // A restarted server is found again within our own waits.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1'000);
  // The time for TCP, TLS and the server's first frame. Who refuses a
  // connection does so at once.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5'000);
  return arguments;
}

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(
    const std::string& server, const ChannelSecurity& security,
    ChannelKind kind, std::chrono::milliseconds ping_after) {
  const absl::StatusOr<ServerAddress> address = ParseServerAddress(server);
  if (!address.ok()) return address.status();
  if (security.tls && security.name.empty() && address->list) {
    return absl::InvalidArgumentError(
        "certificates of several addresses are checked against one name; say "
        "which (--tls-name)");
  }
  auto credentials = Credentials(security);
  if (!credentials.ok()) return credentials.status();
  const grpc::ChannelArguments arguments =
      Arguments(*address, security, kind, ping_after);
  if (security.token.empty()) {
    return grpc::CreateCustomChannel(address->target, *credentials, arguments);
  }
  if (!security.tls && !address->loopback) {
    return absl::InvalidArgumentError(
        "the token would go to " + server +
        " for everybody on the way to read; ask for TLS (--tls)");
  }
  absl::StatusOr<std::string> token = ReadToken(security.token);
  if (!token.ok()) return token.status();
  std::vector<std::unique_ptr<ClientInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(std::make_unique<TokenAdderFactory>(
      std::make_shared<TokenFile>(security.token, *std::move(token))));
  return grpc::experimental::CreateCustomChannelWithInterceptors(
      address->target, *credentials, arguments, std::move(interceptors));
}

}  // namespace terrane::client
