#include "server/service/cpu_quota.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

namespace terrane::server {
namespace {

// CPUs that one cpu.max file allows ("max 100000" or "150000 100000").
int QuotaOf(const std::filesystem::path& file, int unlimited) {
  std::ifstream in(file);
  double quota_us = 0;
  double period_us = 0;
  if (!(in >> quota_us >> period_us) || quota_us <= 0 || period_us <= 0) {
    return unlimited;
  }
  const double cpus = std::ceil(quota_us / period_us);
  return cpus < unlimited ? std::max(1, static_cast<int>(cpus)) : unlimited;
}

// The process's group in the version 2 hierarchy: the line "0::/path".
std::filesystem::path GroupPath(const std::string& self_cgroup) {
  std::istringstream lines(self_cgroup);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("0::/")) return line.substr(4);
  }
  return {};
}

}  // namespace

int CpusWithinQuota(int cores, const std::string& self_cgroup,
                    const std::filesystem::path& cgroup_root) {
  int cpus = cores;
  std::filesystem::path group = GroupPath(self_cgroup);
  while (true) {
    cpus = std::min(cpus, QuotaOf(cgroup_root / group / "cpu.max", cpus));
    if (group.empty()) return cpus;
    group = group.parent_path();
  }
}

int UsableCpus() {
  const int cores =
      std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::ostringstream self_cgroup;
  self_cgroup << std::ifstream("/proc/self/cgroup").rdbuf();
  return CpusWithinQuota(cores, self_cgroup.str(), "/sys/fs/cgroup");
}

}  // namespace terrane::server
