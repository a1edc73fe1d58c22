#include "server/actor/control_group.h"

#include <fstream>
#include <sstream>

namespace terrane::server {
namespace {

// Whether a list such as "cpu,cpuacct" names a controller; that of version 2
// names none.
bool Names(std::string_view controllers, std::string_view controller) {
  while (true) {
    const std::size_t comma = controllers.find(',');
    if (controllers.substr(0, comma) == controller) return true;
    if (comma == controllers.npos) return false;
    controllers.remove_prefix(comma + 1);
  }
}

}  // namespace

std::string SelfControlGroups() {
  std::ostringstream text;
  text << std::ifstream("/proc/self/cgroup").rdbuf();
  return text.str();
}

std::filesystem::path ControlGroupOf(const std::string& self_cgroup,
                                     std::string_view controller) {
  std::istringstream lines(self_cgroup);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t id_end = line.find(':');
    if (id_end == line.npos) continue;
    const std::size_t controllers_end = line.find(":/", id_end + 1);
    if (controllers_end == line.npos) continue;
    const std::string_view controllers =
        std::string_view(line).substr(id_end + 1, controllers_end - id_end - 1);
    if (Names(controllers, controller)) return line.substr(controllers_end + 2);
  }
  return {};
}

std::vector<std::filesystem::path> FilesUpwards(
    const std::filesystem::path& hierarchy, std::filesystem::path group,
    const std::string& file) {
  std::vector<std::filesystem::path> files;
  while (!group.empty()) {
    files.push_back(hierarchy / group / file);
    group = group.parent_path();
  }
  files.push_back(hierarchy / file);
  return files;
}

}  // namespace terrane::server
