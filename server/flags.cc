#include "server/flags.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <sstream>

#include "server/actor/cpu_quota.h"
#include "server/service/memory_watch.h"

namespace terrane::server {
namespace {

constexpr int kExitUsage = 2;

// As CLI::Range, which takes NaN for a number in it.
CLI::Validator Between(double low, double high) {
  std::ostringstream range;
  range << "FLOAT in [" << low << " - " << high << "]";
  return CLI::Validator(
      [low, high, text = range.str()](const std::string& value) {
        double number = 0;
        const bool good = CLI::detail::lexical_cast(value, number) &&
                          number >= low && number <= high;
        return good ? std::string() : "Value " + value + " not in " + text;
      },
      range.str());
}

// Only what cannot be another machine's: a name other than localhost might
// resolve to anything.
bool IsLoopback(const std::string& address) {
  const std::string host = HostOf(address);
  in_addr numeric{};
  if (inet_pton(AF_INET, host.c_str(), &numeric) == 1) {
    return (ntohl(numeric.s_addr) >> 24) == IN_LOOPBACKNET;
  }
  return host == "localhost" || host == "[::1]";
}

std::string Footer() {
  const Limits limits;
  return "Limits of a request (GetServerInfo answers those in force):\n"
         "  levels 0 to " +
         std::to_string(limits.max_level) + ", " +
         std::to_string(limits.max_stream_samples) + " samples a stream, " +
         std::to_string(limits.max_points) + " points, " +
         std::to_string(limits.max_profile_samples) +
         " samples a profile,\n  " +
         std::to_string(limits.recipe.max_discrete_constraints) +
         " discrete and " +
         std::to_string(limits.recipe.max_continuous_constraints) +
         " continuous constraints, " +
         std::to_string(limits.recipe.max_vertices) + " vertices, " +
         std::to_string(limits.recipe.max_macro_parts) + " macro parts,\n  " +
         std::to_string(limits.recipe.max_inline_spots) +
         " spot points and as many lines a recipe; more as a table\n\n"
         "Examples:\n"
         "  terrane-server --listen 127.0.0.1:0\n"
         "  terrane-server --workers 4 --log-format json 2>server.log\n"
         "  terrane-server --listen 0.0.0.0:50051 --tls-cert server.pem "
         "--tls-key server.key\n"
         "  terrane-server --listen 0.0.0.0:50051 --insecure   "
         "(behind a proxy that ends TLS)\n";
}

void AddNetworkFlags(CLI::App* app, Flags* flags) {
  app->option_defaults()->group("Network");
  app->add_option("--listen", flags->server.listen,
                  "Address and port; port 0 takes a free one and prints it")
      ->capture_default_str();
  app->add_option("--max-connections",
                  flags->server.connections.max_connections,
                  "Connections open at a time, one more is reset; fewer where "
                  "the limit of descriptors is lower")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app->add_option("--max-connection-age-seconds", flags->max_age_seconds,
                  "After this long a connection takes no new call, which "
                  "spreads clients over replicas again")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app->add_flag("--reflection", flags->server.reflection,
                "Answer gRPC server reflection (grpcurl, buf curl)");
  app->add_option("--grace-seconds", flags->grace_seconds,
                  "After SIGTERM or SIGINT calls are still taken for this long "
                  "while probes say that it ends: longer than a balancer needs "
                  "to notice")
      ->check(Between(0, 600))
      ->capture_default_str();
  app->add_option("--drain-seconds", flags->drain_seconds,
                  "Time for running calls to end after that")
      ->check(CLI::Range(0, 3600))
      ->capture_default_str();
}

void AddSecurityFlags(CLI::App* app, Flags* flags) {
  app->option_defaults()->group("Security");
  TlsFiles& tls = flags->server.tls;
  CLI::Option* certificate = app->add_option(
      "--tls-cert", tls.certificate,
      "Serve TLS with this certificate chain (PEM); looked at every ten "
      "seconds, so that a new one needs no restart");
  CLI::Option* key =
      app->add_option("--tls-key", tls.key, "Its private key (PEM)");
  certificate->needs(key);
  key->needs(certificate);
  app->add_option("--tls-client-ca", tls.client_ca,
                  "Demand client certificates that these sign (PEM)")
      ->needs(certificate);
  app->add_flag("--insecure", flags->insecure,
                "Allow an address that other machines reach, without TLS");
  TokenOptions& tokens = flags->server.access.tokens;
  CLI::Option* jwt_key =
      app->add_option("--jwt-key", tokens.key_files,
                      "Demand bearer tokens (JWT) that this public key (PEM) "
                      "verifies: RS256 or ES256; more than once while an "
                      "issuer changes its key")
          ->allow_extra_args(false);
  app->add_option("--jwt-issuer", tokens.issuer,
                  "Take only tokens of this issuer (iss)")
      ->needs(jwt_key);
  app->add_option("--jwt-audience", tokens.audience,
                  "Take only tokens for this audience (aud)")
      ->needs(jwt_key);
  AccessOptions& access = flags->server.access;
  app->add_option("--client-streams", access.client_calls,
                  "Calls of one client at a time, a token's subject or else a "
                  "host; 0: any number")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  app->add_option("--client-rate", access.client_rate,
                  "Calls a second of one client in the long run; what comes in "
                  "ten seconds may come at once; 0: any number")
      ->check(Between(0, 1e6))
      ->capture_default_str();
  app->add_option("--client-workers", access.client_workers,
                  "Workers that one client may keep busy in the long run, such "
                  "as 0.5; 0: all")
      ->check(Between(0, 1e3))
      ->capture_default_str();
  app->add_flag("--trust-forwarded-for", access.trust_forwarded_for,
                "Without tokens, a client is the last address of "
                "x-forwarded-for: for a server that only a proxy reaches");
}

void AddWorkFlags(CLI::App* app, Flags* flags) {
  app->option_defaults()->group("Work");
  Limits& limits = flags->server.limits;
  app->add_option("--workers", flags->workers,
                  "Generating threads; 0: one per usable CPU (cgroup quota "
                  "respected)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app->add_option("--max-streams", limits.max_concurrent_streams,
                  "Streams generated at the same time; four times as many may "
                  "wait")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app->add_option("--patience-seconds", flags->patience_seconds,
                  "A call without a deadline is refused when it would not "
                  "begin in this time")
      ->check(CLI::Range(1, 86'400))
      ->capture_default_str();
  app->add_option("--stream-idle-seconds", flags->stream_idle_seconds,
                  "A stream whose reader takes nothing for this time is ended")
      ->check(CLI::Range(1, 86'400))
      ->capture_default_str();
  app->add_option("--raster-store-mib", flags->raster_store_mib,
                  "Memory for uploaded rasters, in MiB (default: 1024, or a "
                  "quarter of the memory limit where that is less)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 20));
  app->add_option("--prepared-mib", flags->prepared_mib,
                  "Memory for recipes made ready and kept, in MiB; what takes "
                  "more to make ready is refused (default: 2048, or a quarter "
                  "of the memory limit where that is less)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 20));
}

void AddLimitFlags(CLI::App* app, Flags* flags) {
  app->option_defaults()->group("Limits");
  Limits& limits = flags->server.limits;
  app->add_option("--max-tile-size", limits.max_tile_size,
                  "Largest side of a tile in samples")
      ->check(CLI::Range(2, 4097))
      ->capture_default_str();
  app->add_option("--max-stream-samples", limits.max_stream_samples,
                  "Most samples of one stream")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 52))
      ->capture_default_str();
  app->add_option("--max-request-bytes", limits.max_request_bytes,
                  "Largest request message; chunks of rasters included")
      ->check(CLI::Range(std::int64_t{1} << 12, std::int64_t{1} << 26))
      ->capture_default_str();
  app->add_option("--max-spots", limits.recipe.max_spots,
                  "Most spot heights of a recipe")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
}

void AddMonitoringFlags(CLI::App* app, Flags* flags) {
  constexpr char kGroup[] = "Monitoring";
  app->add_option(
         "--http-listen", flags->server.http_listen,
         "Address and port for /livez, /readyz and /metrics over plain "
         "HTTP; off unless given")
      ->group(kGroup);
  app->add_option("--memory-limit-mib", flags->memory_limit_mib,
                  "Memory of the process, in MiB: above nine tenths of it new "
                  "streams are refused; 0: the limit of the control group")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 30))
      ->capture_default_str()
      ->group(kGroup);
}

void AddLogFlags(CLI::App* app, Flags* flags) {
  app->option_defaults()->group("Logs");
  app->add_option("--log-level", flags->log_level, "Least level that is logged")
      ->check(CLI::IsMember(
          {"trace", "debug", "info", "warning", "error", "critical", "off"}))
      ->capture_default_str();
  app->add_option("--log-format", flags->log_format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
}

// The tighter one of what the flag and the control group say.
std::optional<std::int64_t> MemoryLimit(const Flags& flags) {
  const std::optional<std::int64_t> group_limit = ControlGroupMemoryLimit();
  if (flags.memory_limit_mib == 0) return group_limit;
  const std::int64_t limit = flags.memory_limit_mib << 20;
  return std::min(limit, group_limit.value_or(limit));
}

// What stores keep stays: together they must fit into the memory limit.
std::optional<std::string> StoresConflict(const Flags& flags) {
  const std::optional<std::int64_t> limit = MemoryLimit(flags);
  const std::int64_t mib =
      flags.raster_store_mib.value_or(0) + flags.prepared_mib.value_or(0);
  if (!limit.has_value() || mib << 20 <= *limit) return std::nullopt;
  return "--raster-store-mib and --prepared-mib must be at most " +
         std::to_string(*limit >> 20) +
         " together, the memory limit in MiB, got " + std::to_string(mib);
}

// Says what is wrong with flags that are right one by one.
std::optional<std::string> Conflict(const Flags& flags) {
  const std::string& listen = flags.server.listen;
  if (listen.find(':') == std::string::npos) {
    return "--listen must be ADDRESS:PORT, got " + listen;
  }
  const std::string& http_listen = flags.server.http_listen;
  if (!http_listen.empty() && http_listen.find(':') == std::string::npos) {
    return "--http-listen must be ADDRESS:PORT, got " + http_listen;
  }
  if (!flags.server.tls.on() && !flags.insecure && !IsLoopback(listen)) {
    return "--listen " + listen +
           " is reachable from other machines; use 127.0.0.1, or --tls-cert "
           "and --tls-key, or add --insecure to serve it without TLS";
  }
  return StoresConflict(flags);
}

// A store must fit into the memory limit beside the other one and the work.
std::int64_t StoreBytes(std::optional<std::int64_t> mib, std::int64_t usual,
                        std::optional<std::int64_t> memory_limit) {
  if (mib.has_value()) return *mib << 20;
  return std::min(usual, memory_limit.value_or(4 * usual) / 4);
}

// What follows from the flags.
void Resolve(Flags* flags) {
  Limits& limits = flags->server.limits;
  const std::optional<std::int64_t> memory_limit = MemoryLimit(*flags);
  flags->server.memory_limit_bytes = memory_limit;
  limits.raster_store_bytes = StoreBytes(
      flags->raster_store_mib, limits.raster_store_bytes, memory_limit);
  limits.prepared_bytes =
      StoreBytes(flags->prepared_mib, limits.prepared_bytes, memory_limit);
  limits.render_bytes =
      StoreBytes(std::nullopt, limits.render_bytes, memory_limit);
  limits.recipe.max_inline_spots =
      std::min(limits.recipe.max_inline_spots, limits.recipe.max_spots);
  limits.max_raster_samples =
      std::min(limits.max_raster_samples,
               limits.raster_store_bytes / std::int64_t{sizeof(float)});
  flags->server.stream_idle = std::chrono::seconds(flags->stream_idle_seconds);
  flags->server.patience = std::chrono::seconds(flags->patience_seconds);
  flags->server.connections.max_age =
      std::chrono::seconds(flags->max_age_seconds);
  flags->server.workers = flags->workers > 0 ? flags->workers : UsableCpus();
}

}  // namespace

std::string HostOf(const std::string& address) {
  return address.substr(0, address.rfind(':'));
}

std::optional<int> ParseFlags(int argc, char** argv, Flags* flags) {
  CLI::App app("Serves Terrane's generators over gRPC (terrane.v1).");
  AddNetworkFlags(&app, flags);
  AddSecurityFlags(&app, flags);
  AddWorkFlags(&app, flags);
  AddLimitFlags(&app, flags);
  AddMonitoringFlags(&app, flags);
  AddLogFlags(&app, flags);
  app.set_version_flag("--version", "terrane-server " TERRANE_VERSION);
  app.footer(Footer());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  if (const std::optional<std::string> conflict = Conflict(*flags)) {
    std::cerr << "terrane-server: " << *conflict << '\n';
    return kExitUsage;
  }
  Resolve(flags);
  return std::nullopt;
}

}  // namespace terrane::server
