// The command line of terrane-server.
#ifndef TERRANE_SERVER_FLAGS_H_
#define TERRANE_SERVER_FLAGS_H_

#include <cstdint>
#include <optional>
#include <string>

#include "server/service/server.h"

namespace terrane::server {

struct Flags {
  ServerOptions server;
  bool insecure = false;
  int max_age_seconds = 3600;
  int workers = 0;
  std::optional<std::int64_t> raster_store_mib;
  std::optional<std::int64_t> prepared_mib;
  int patience_seconds = 60;
  int stream_idle_seconds = 60;
  // For balancers to see NOT_SERVING before the port closes.
  double grace_seconds = 0.2;
  int drain_seconds = 30;
  std::int64_t memory_limit_mib = 0;
  std::string log_level = "info";
  std::string log_format = "text";
};

// Fills `flags`; the exit code when the program is to end now: after --help and
// --version, or because the command line is wrong, which was said on standard
// error.
std::optional<int> ParseFlags(int argc, char** argv, Flags* flags);

// "127.0.0.1:0" -> "127.0.0.1"; "[::1]:0" -> "[::1]".
std::string HostOf(const std::string& address);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_FLAGS_H_
