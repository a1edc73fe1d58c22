// How many connections this process may have descriptors for.
#ifndef TERRANE_SERVER_SERVICE_DESCRIPTOR_LIMIT_H_
#define TERRANE_SERVER_SERVICE_DESCRIPTOR_LIMIT_H_

namespace terrane::server {

// Makes room for `wanted` connections: raises the soft limit of descriptors
// (RLIMIT_NOFILE) as far as they need and the hard limit lets it. Answers how
// many fit, at least 1 and at most `wanted`, with descriptors to spare for the
// rest of the server. Threads: at the start, from one.
int FitConnections(int wanted);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_DESCRIPTOR_LIMIT_H_
