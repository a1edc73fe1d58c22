// terrane-server: serves Terrane's generators over gRPC.
//
// Standard output holds the line "listening on ADDRESS:PORT", and with
// --http-listen a second one, "http on ADDRESS:PORT"; logs go to standard
// error. SIGTERM and SIGINT drain and exit 0; a second one ends at once. Exit
// codes: 0 ok, 1 error, 2 usage.
#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "absl/synchronization/mutex.h"
#include "server/actor/actor.h"
#include "server/flags.h"
#include "server/service/server.h"

namespace terrane::server {
namespace {

constexpr int kExitError = 1;

// Blocks of this size and more go back to the kernel as they are freed. By
// itself the allocator soon keeps blocks of up to 32 MiB, rasters and tiles,
// and the holes between them count against the memory limit.
constexpr int kReturnedBlockBytes = 1 << 20;

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
  if (const auto http_port = (*server)->http_port()) {
    const std::string http_address =
        HostOf(flags.server.http_listen) + ":" + std::to_string(*http_port);
    std::cout << "http on " << http_address << std::endl;
    log.Event("http", http_address);
  }

  int signal = 0;
  sigwait(&signals, &signal);
  EndAtNextSignal(signals);
  log.Event("draining", strsignal(signal));
  const std::chrono::duration<double> grace(flags.grace_seconds);
  (*server)->Drain(std::chrono::duration_cast<std::chrono::milliseconds>(grace),
                   std::chrono::seconds(flags.drain_seconds));
  log.Event("stopped", "all calls have ended");
  return 0;
}

int Main(int argc, char** argv) {
  // gRPC's locks are Abseil's, which look for deadlocks at every step in
  // Debian's package, as if it were a debug build.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  mallopt(M_MMAP_THRESHOLD, kReturnedBlockBytes);
  Flags flags;
  if (const auto exit_code = ParseFlags(argc, argv, &flags)) return *exit_code;
  const int exit_code = Serve(flags);
  spdlog::shutdown();  // writes what is still queued
  return exit_code;
}

}  // namespace
}  // namespace terrane::server

int main(int argc, char** argv) { return terrane::server::Main(argc, argv); }
