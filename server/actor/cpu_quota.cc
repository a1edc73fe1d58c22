#include "server/actor/cpu_quota.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "server/actor/control_group.h"

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

}  // namespace

int CpusWithinQuota(int cores, const std::string& self_cgroup,
                    const std::filesystem::path& cgroup_root) {
  int cpus = cores;
  for (const auto& file :
       FilesUpwards(cgroup_root, ControlGroupOf(self_cgroup, ""), "cpu.max")) {
    cpus = std::min(cpus, QuotaOf(file, cpus));
  }
  return cpus;
}

int UsableCpus() {
  const int cores =
      std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return CpusWithinQuota(cores, SelfControlGroups(), kControlGroupRoot);
}

}  // namespace terrane::server
