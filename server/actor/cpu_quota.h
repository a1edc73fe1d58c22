// How many threads can really run: the cores this process may use, cut by the
// CPU quota of its control group (cgroup v2), as containers and systemd set it.
// So many workers has a server, and so many threads `terrane --local`.
#ifndef TERRANE_SERVER_ACTOR_CPU_QUOTA_H_
#define TERRANE_SERVER_ACTOR_CPU_QUOTA_H_

#include <filesystem>
#include <string>

namespace terrane::server {

// At least 1. Reads /proc and /sys; what it cannot read sets no quota.
int UsableCpus();

// The same for `cores` cores, with the text of /proc/self/cgroup and the place
// where the cgroup file system is mounted. The tightest quota of the group and
// of those above it counts, rounded up.
int CpusWithinQuota(int cores, const std::string& self_cgroup,
                    const std::filesystem::path& cgroup_root);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_CPU_QUOTA_H_
