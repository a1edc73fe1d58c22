// The control groups of this process, as containers and systemd set them: where
// the limits of CPU and memory are written.
//
// Version 2 has one hierarchy; version 1 has one a controller, in a folder of
// its name. A limit of a group holds for the groups below it, so whoever looks
// for the tightest one reads the same file all the way up. Threads: any.
#ifndef TERRANE_SERVER_ACTOR_CONTROL_GROUP_H_
#define TERRANE_SERVER_ACTOR_CONTROL_GROUP_H_

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace terrane::server {

// Where the control group file systems are mounted.
inline constexpr char kControlGroupRoot[] = "/sys/fs/cgroup";

// The text of /proc/self/cgroup: a line "ID:CONTROLLERS:/PATH" a hierarchy.
// Empty where there is none.
std::string SelfControlGroups();

// The process's group in the hierarchy of a controller of version 1, or in that
// of version 2 when `controller` is empty; relative to the hierarchy's root,
// which is also the answer when there is no such hierarchy.
std::filesystem::path ControlGroupOf(const std::string& self_cgroup,
                                     std::string_view controller);

// `file` of a group and of every group above it up to `hierarchy`, the folder
// of the root.
std::vector<std::filesystem::path> FilesUpwards(
    const std::filesystem::path& hierarchy, std::filesystem::path group,
    const std::string& file);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_CONTROL_GROUP_H_
