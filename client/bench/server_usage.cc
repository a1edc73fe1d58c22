#include "client/bench/server_usage.h"

#include <cpl_http.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <vector>

namespace terrane::client {
namespace {

constexpr double kBytesOfKib = 1024;
// Of a /proc/PID/stat line, counted from the state, which follows the name.
constexpr std::size_t kUserTicks = 11;
constexpr std::size_t kSystemTicks = 12;

struct HttpResultDeleter {
  void operator()(CPLHTTPResult* result) const { CPLHTTPDestroyResult(result); }
};

std::optional<double> CpuSecondsOf(const std::string& folder) {
  std::ifstream file(folder + "/stat");
  std::string line;
  std::getline(file, line);
  // The name, in parentheses, may hold anything.
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream rest(line.substr(name_end + 1));
  const std::vector<std::string> fields{
      std::istream_iterator<std::string>(rest), {}};
  if (fields.size() <= kSystemTicks) return std::nullopt;
  return (std::stod(fields[kUserTicks]) + std::stod(fields[kSystemTicks])) /
         static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::optional<double> MemoryOf(const std::string& folder) {
  std::ifstream file(folder + "/status");
  std::string word;
  while (file >> word) {
    double kib = 0;
    if (word == "VmRSS:" && file >> kib) return kib * kBytesOfKib;
  }
  return std::nullopt;
}

void Add(double value, std::optional<double>* sum) {
  *sum = sum->value_or(0) + value;
}

}  // namespace

absl::StatusOr<Usage> UsageOfProcess(int pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  const Usage usage{CpuSecondsOf(folder), MemoryOf(folder)};
  if (!usage.cpu_seconds.has_value() || !usage.memory_bytes.has_value()) {
    return absl::NotFoundError("no process " + std::to_string(pid) +
                               " to read on this machine");
  }
  return usage;
}

absl::StatusOr<Usage> UsageOfMetrics(const std::string& url) {
  // A proxy of the environment is not the way to a server under test.
  const char* const options[] = {"TIMEOUT=2", "PROXY=", nullptr};
  const std::unique_ptr<CPLHTTPResult, HttpResultDeleter> answer(
      CPLHTTPFetch(url.c_str(), options));
  if (answer == nullptr || answer->nStatus != 0 ||
      answer->pszErrBuf != nullptr) {
    return absl::NotFoundError("no metrics at " + url);
  }
  const std::string text(answer->pabyData, answer->pabyData + answer->nDataLen);
  const Usage usage = UsageOfMetricsText(text);
  if (!usage.cpu_seconds.has_value() && !usage.memory_bytes.has_value()) {
    return absl::NotFoundError(
        "neither CPU time nor memory among the metrics "
        "at " +
        url);
  }
  return usage;
}

Usage UsageOfMetricsText(const std::string& text) {
  Usage usage;
  std::optional<double> resident;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    const std::string name = line.substr(0, line.find_first_of("{ "));
    const std::size_t space = line.find(' ', line.rfind('}') + 1);
    if (line.starts_with('#') || space == std::string::npos) continue;
    double value = 0;
    if (!(std::istringstream(line.substr(space)) >> value)) continue;
    if (name == "process_cpu_seconds_total") {
      Add(value, &usage.cpu_seconds);
    } else if (name == "terrane_memory_bytes") {
      Add(value, &usage.memory_bytes);
    } else if (name == "process_resident_memory_bytes") {
      Add(value, &resident);
    }
  }
  if (!usage.memory_bytes.has_value()) usage.memory_bytes = resident;
  return usage;
}

void UsageWatch::Look(TimePoint now) {
  const absl::StatusOr<Usage> usage = source_();
  if (!usage.ok()) return;
  last_ = {now, *usage};
  if (!first_.has_value()) first_ = last_;
  peak_ = std::max(peak_, usage->memory_bytes.value_or(0));
}

std::optional<double> UsageWatch::cpus() const {
  if (!first_.has_value()) return std::nullopt;
  const std::chrono::duration<double> time = last_.time - first_->time;
  const std::optional<double> begin = first_->usage.cpu_seconds;
  const std::optional<double> end = last_.usage.cpu_seconds;
  if (!begin.has_value() || !end.has_value() || time.count() <= 0) {
    return std::nullopt;
  }
  return (*end - *begin) / time.count();
}

}  // namespace terrane::client
