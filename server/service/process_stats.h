// What the kernel says of this process. Threads: any.
#ifndef TERRANE_SERVER_SERVICE_PROCESS_STATS_H_
#define TERRANE_SERVER_SERVICE_PROCESS_STATS_H_

namespace terrane::server {

// Time on CPUs, in user and in system mode together.
double CpuSeconds();

// Open file descriptors; 0 where /proc does not tell.
int OpenFiles();

// Threads; 0 where /proc does not tell.
int ThreadCount();

}  // namespace terrane::server

#endif  // TERRANE_SERVER_SERVICE_PROCESS_STATS_H_
