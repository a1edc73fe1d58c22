// What the program that is linked with this asks of fsync and rename.
#ifndef TERRANE_TESTS_CLIENT_DISK_CALLS_H_
#define TERRANE_TESTS_CLIENT_DISK_CALLS_H_

#include <string>
#include <vector>

namespace terrane::client {

// "fsync PATH" and "rename FROM to TO" of every call so far, in order. For
// tests of one thread.
std::vector<std::string>& DiskCalls();

}  // namespace terrane::client

#endif  // TERRANE_TESTS_CLIENT_DISK_CALLS_H_
