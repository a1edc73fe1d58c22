// OutputFile: a file that appears under its name only when it is whole.
//
// Written under a temporary name in the same folder (.NAME.partial- and
// chance), with the rights that the umask leaves; Commit flushes it to the disk
// and renames it. Without a Commit (an error, a full disk, an interrupt) the
// destructor removes the temporary file, and whatever had the name before
// stays. Only a crash leaves a temporary file behind.
//
// Any number of processes, on any machines, may write the same name at a time:
// it is always one of theirs, whole.
//
// Belongs to one thread. Errors name the final path and the system's reason.
#ifndef TERRANE_CLIENT_OUTPUT_FILE_H_
#define TERRANE_CLIENT_OUTPUT_FILE_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace terrane::client {

class OutputFile {
 public:
  // Creates the temporary file, empty, open for reading and writing.
  static absl::StatusOr<OutputFile> Create(std::string path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  ~OutputFile();

  const std::string& path() const { return path_; }
  // Where a library that opens files by name writes.
  const std::string& temporary_path() const { return temporary_path_; }

  absl::Status WriteAt(std::int64_t offset, std::span<const std::byte> bytes);
  // Reads exactly as many bytes as `bytes` takes.
  absl::Status ReadAt(std::int64_t offset, std::span<std::byte> bytes) const;

  // The file gets its name. Call once, last.
  absl::Status Commit();

 private:
  OutputFile(std::string path, std::string temporary_path, int descriptor);
  void Discard();
  absl::Status SystemError(const char* action) const;

  std::string path_;
  // Empty once the file was committed or moved away.
  std::string temporary_path_;
  int descriptor_ = -1;
};

// Writes a whole file in one go.
absl::Status WriteFile(const std::string& path,
                       std::span<const std::byte> bytes);

// Makes the names of all files in the folder of `path` outlast a crash of the
// system, too. It takes as long as the flush of a file. A folder that may not
// be read and a file system that cannot do this leave the names as safe as they
// make them.
absl::Status FlushFolderOf(const std::string& path);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_OUTPUT_FILE_H_
