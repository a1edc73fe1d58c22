// What the options of a load test come to: its connections, and all that shapes
// it, for a later one to compare with. Pure functions.
#ifndef TERRANE_CLIENT_BENCH_LOAD_SETTINGS_H_
#define TERRANE_CLIENT_BENCH_LOAD_SETTINGS_H_

#include <map>
#include <string>

#include "client/bench/bench_run.h"

namespace terrane::client {

// TCP connections to each replica. Without --connections one for each caller,
// up to eight, and one for every hundred calls that may be in flight: what
// deploy's HAProxy takes of one (terrane-server: 256).
int ConnectionsOf(const BenchOptions& options);

// Calls that one connection may have to carry. What is more than a server takes
// waits in this process, and looks like the server's latency.
int CallsOfAConnection(const BenchOptions& options);

// By the name of its option. Not where the server is, nor what is reported: of
// two servers the same load can be compared.
using LoadSettings = std::map<std::string, std::string>;
LoadSettings SettingsOf(const BenchOptions& options);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_LOAD_SETTINGS_H_
