#include "client/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

namespace terrane::client {
namespace {

// Hidden beside the final name, so that a rename never crosses file systems.
// Chance keeps writers of the same file apart: on storage that several machines
// share, process numbers would not.
std::string TemporaryName(const std::string& path) {
  const std::filesystem::path final_path(path);
  std::random_device chance;
  const std::string name =
      fmt::format(".{}.partial-{:08x}{:08x}", final_path.filename().string(),
                  chance(), chance());
  return (final_path.parent_path() / name).string();
}

absl::Status ErrnoStatus(const std::string& action, const std::string& path) {
  const std::error_code code(errno, std::generic_category());
  return absl::UnknownError(action + " " + path + ": " + code.message());
}

}  // namespace

absl::StatusOr<OutputFile> OutputFile::Create(std::string path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return absl::InvalidArgumentError("cannot write " + path +
                                      ": it is a folder");
  }
  std::string temporary_path = TemporaryName(path);
  const int descriptor =
      open(temporary_path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return ErrnoStatus("cannot create", path);
  return OutputFile(std::move(path), std::move(temporary_path), descriptor);
}

OutputFile::OutputFile(std::string path, std::string temporary_path,
                       int descriptor)
    : path_(std::move(path)),
      temporary_path_(std::move(temporary_path)),
      descriptor_(descriptor) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_path_(std::exchange(other.temporary_path_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    Discard();
    path_ = std::move(other.path_);
    temporary_path_ = std::exchange(other.temporary_path_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

OutputFile::~OutputFile() { Discard(); }

void OutputFile::Discard() {
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
  if (!temporary_path_.empty()) unlink(temporary_path_.c_str());
  temporary_path_.clear();
}

absl::Status OutputFile::SystemError(const char* action) const {
  return ErrnoStatus(action, path_);
}

absl::Status OutputFile::WriteAt(std::int64_t offset,
                                 std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        pwrite(descriptor_, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return SystemError("cannot write");
    offset += written;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return absl::OkStatus();
}

absl::Status OutputFile::ReadAt(std::int64_t offset,
                                std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = pread(descriptor_, bytes.data(), bytes.size(), offset);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return SystemError("cannot read back");
    if (got == 0) {
      return absl::DataLossError("cannot read back " + path_ +
                                 ": it is too short");
    }
    offset += got;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return absl::OkStatus();
}

absl::Status OutputFile::Commit() {
  if (fsync(descriptor_) != 0) return SystemError("cannot flush");
  if (close(std::exchange(descriptor_, -1)) != 0) {
    return SystemError("cannot close");
  }
  if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    return SystemError("cannot rename the finished file to");
  }
  temporary_path_.clear();
  return absl::OkStatus();
}

absl::Status WriteFile(const std::string& path,
                       std::span<const std::byte> bytes) {
  absl::StatusOr<OutputFile> file = OutputFile::Create(path);
  if (!file.ok()) return file.status();
  const absl::Status status = file->WriteAt(0, bytes);
  if (!status.ok()) return status;
  return file->Commit();
}

absl::Status FlushFolderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(),
                              O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return absl::OkStatus();
  absl::Status status;
  if (fsync(descriptor) != 0 && errno != EINVAL) {
    status = ErrnoStatus("cannot flush the folder of", path);
  }
  close(descriptor);
  return status;
}

}  // namespace terrane::client
