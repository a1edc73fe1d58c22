// terrane-server: serves Terrane's generators over gRPC.
//
// Standard output holds one line, "listening on ADDRESS:PORT"; logs go to
// standard error. SIGTERM and SIGINT drain and exit 0; a second one ends at
// once. Exit codes: 0 ok, 1 error, 2 usage.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <iostream>
#include <string>
#include <thread>

#include "server/actor/actor.h"
#include "server/service/cpu_quota.h"
#include "server/service/server.h"

namespace terrane::server {
namespace {

constexpr int kExitError = 1;
constexpr int kExitUsage = 2;
// For balancers to see NOT_SERVING before the port closes.
constexpr std::chrono::milliseconds kGrace{200};

struct Flags {
  ServerOptions server;
  bool insecure = false;
  int workers = 0;
  std::int64_t raster_store_mib = 1024;
  std::int64_t prepared_mib = 2048;
  int drain_seconds = 30;
  std::string log_level = "info";
  std::string log_format = "text";
};

// "127.0.0.1:0" -> "127.0.0.1"; "[::1]:0" -> "[::1]".
std::string HostOf(const std::string& address) {
  return address.substr(0, address.rfind(':'));
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
         "  terrane-server --listen 0.0.0.0:50051 --insecure   "
         "(behind a proxy that ends TLS)\n";
}

void AddFlags(CLI::App* app, Flags* flags) {
  Limits& limits = flags->server.limits;
  app->add_option("--listen", flags->server.listen,
                  "Address and port; port 0 takes a free one and prints it")
      ->capture_default_str();
  app->add_flag("--insecure", flags->insecure,
                "Allow an address that other machines reach, without TLS");
  app->add_option("--workers", flags->workers,
                  "Generating threads; 0: one per usable CPU (cgroup quota "
                  "respected)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
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
  app->add_option("--max-streams", limits.max_concurrent_streams,
                  "Streams generated at the same time; four times as many may "
                  "wait")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app->add_option("--raster-store-mib", flags->raster_store_mib,
                  "Memory for uploaded rasters, in MiB")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 20))
      ->capture_default_str();
  app->add_option("--prepared-mib", flags->prepared_mib,
                  "Memory for recipes made ready and kept, in MiB; what takes "
                  "more to make ready is refused")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 20))
      ->capture_default_str();
  app->add_option("--max-spots", limits.recipe.max_spots,
                  "Most spot heights of a recipe")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app->add_option("--drain-seconds", flags->drain_seconds,
                  "Time for running calls to end after SIGTERM or SIGINT")
      ->check(CLI::Range(0, 3600))
      ->capture_default_str();
  app->add_option("--log-level", flags->log_level, "Least level that is logged")
      ->check(CLI::IsMember(
          {"trace", "debug", "info", "warning", "error", "critical", "off"}))
      ->capture_default_str();
  app->add_option("--log-format", flags->log_format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  app->add_flag("--reflection", flags->server.reflection,
                "Answer gRPC server reflection (grpcurl, buf curl)");
  app->set_version_flag("--version", "terrane-server " TERRANE_VERSION);
  app->footer(Footer());
}

// The signals that end the server, blocked in this thread and so in every
// thread that it starts.
sigset_t BlockEndSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

// Waits for a second signal beside the drain; it ends the process at once.
void EndAtNextSignal(const sigset_t& signals) {
  std::thread([signals] {
    int signal = 0;
    sigwait(&signals, &signal);
    _exit(kExitError);
  }).detach();
}

int Serve(const Flags& flags) {
  const sigset_t signals = BlockEndSignals();
  CallLog log(MakeStderrLogger(flags.log_level),
              flags.log_format == "json" ? LogFormat::kJson : LogFormat::kText);
  const std::unique_ptr<Actor> actor =
      MakeActor(flags.server.limits, flags.server.workers);
  auto server = Server::Start(flags.server, actor.get(), &log);
  if (!server.ok()) {
    std::cerr << "terrane-server: " << server.status().message() << "\n";
    return kExitError;
  }
  const std::string address =
      HostOf(flags.server.listen) + ":" + std::to_string((*server)->port());
  std::cout << "listening on " << address << std::endl;
  log.Event("listening", address);

  int signal = 0;
  sigwait(&signals, &signal);
  EndAtNextSignal(signals);
  log.Event("draining", strsignal(signal));
  (*server)->Drain(kGrace, std::chrono::seconds(flags.drain_seconds));
  log.Event("stopped", "all calls have ended");
  return 0;
}

int Main(int argc, char** argv) {
  Flags flags;
  CLI::App app("Serves fractal terrain over gRPC (terrane.v1).");
  AddFlags(&app, &flags);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  if (flags.server.listen.find(':') == std::string::npos) {
    std::cerr << "terrane-server: --listen must be ADDRESS:PORT, got "
              << flags.server.listen << '\n';
    return kExitUsage;
  }
  if (!flags.insecure && !IsLoopback(flags.server.listen)) {
    std::cerr << "terrane-server: --listen " << flags.server.listen
              << " is reachable from other machines; use 127.0.0.1, or add "
                 "--insecure to serve it without TLS\n";
    return kExitUsage;
  }
  flags.server.limits.raster_store_bytes = flags.raster_store_mib << 20;
  flags.server.limits.prepared_bytes = flags.prepared_mib << 20;
  flags.server.limits.recipe.max_inline_spots =
      std::min(flags.server.limits.recipe.max_inline_spots,
               flags.server.limits.recipe.max_spots);
  flags.server.limits.max_raster_samples = std::min(
      flags.server.limits.max_raster_samples,
      flags.server.limits.raster_store_bytes / std::int64_t{sizeof(float)});
  flags.server.workers = flags.workers > 0 ? flags.workers : UsableCpus();
  const int exit_code = Serve(flags);
  spdlog::shutdown();  // writes what is still queued
  return exit_code;
}

}  // namespace
}  // namespace terrane::server

int main(int argc, char** argv) { return terrane::server::Main(argc, argv); }
