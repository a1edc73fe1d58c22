// The checksum of a message's columns. Threads: a pure function.
#ifndef TERRANE_SERVER_CONVERT_COLUMN_CHECKSUM_H_
#define TERRANE_SERVER_CONVERT_COLUMN_CHECKSUM_H_

#include <cstdint>
#include <initializer_list>
#include <string>

namespace terrane::server {

// XXH3 (64 bits, seed 0) of columns, one after the other.
std::uint64_t ColumnChecksum(std::initializer_list<const std::string*> columns);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_COLUMN_CHECKSUM_H_
