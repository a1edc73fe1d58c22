#include "client/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/client/disk_calls.h"
#include "tests/client/temporary_folder.h"

namespace terrane::client {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::span<const std::byte> Bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

std::string Content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

TEST(OutputFile, IsThereOnlyOnceItIsCommitted) {
  const TemporaryFolder folder;
  {
    absl::StatusOr<OutputFile> file = OutputFile::Create(folder.File("a.tif"));
    ASSERT_TRUE(file.ok());
    EXPECT_TRUE(file->WriteAt(0, Bytes("left")).ok());
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
  EXPECT_TRUE(WriteFile(folder.File("a.tif"), Bytes("whole")).ok());
  EXPECT_THAT(folder.Names(), ElementsAre("a.tif"));
  EXPECT_EQ(Content(folder.File("a.tif")), "whole");
}

// As two pods that share a folder, in each of which terrane is process 1.
TEST(OutputFile, WritersOfOneNameDoNotMeet) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.tif");
  absl::StatusOr<OutputFile> first = OutputFile::Create(path);
  absl::StatusOr<OutputFile> second = OutputFile::Create(path);
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_TRUE(first->WriteAt(0, Bytes("the first one's")).ok());
  EXPECT_TRUE(second->WriteAt(0, Bytes("half")).ok());
  EXPECT_TRUE(first->Commit().ok());
  EXPECT_EQ(Content(path), "the first one's");
  EXPECT_TRUE(second->Commit().ok());
  EXPECT_EQ(Content(path), "half");
  EXPECT_THAT(folder.Names(), ElementsAre("a.tif"));
}

TEST(OutputFile, TemporaryFilesAreHiddenAndRecognisable) {
  const TemporaryFolder folder;
  const absl::StatusOr<OutputFile> file =
      OutputFile::Create(folder.File("a.tif"));
  ASSERT_TRUE(file.ok());
  EXPECT_THAT(
      folder.Names(),
      ElementsAre(testing::MatchesRegex(R"(\.a\.tif\.partial-[0-9a-f]{16})")));
}

TEST(OutputFile, TheUmaskSaysWhoMayReadIt) {
  const TemporaryFolder folder;
  const mode_t before = umask(0);
  for (const mode_t mask : {0u, 002u, 022u, 077u}) {
    umask(mask);
    const std::string path = folder.File("a.tif");
    EXPECT_TRUE(WriteFile(path, Bytes("a")).ok());
    struct stat found;
    ASSERT_EQ(stat(path.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0666 & ~mask);
  }
  umask(before);
}

TEST(OutputFile, IsFlushedBeforeItIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.tif");
  absl::StatusOr<OutputFile> file = OutputFile::Create(path);
  ASSERT_TRUE(file.ok());
  const std::string temporary = file->temporary_path();
  DiskCalls().clear();
  EXPECT_TRUE(file->Commit().ok());
  EXPECT_THAT(DiskCalls(), ElementsAre("fsync " + temporary,
                                       "rename " + temporary + " to " + path));
}

TEST(FlushFolderOf, FlushesWhereAFileLies) {
  const TemporaryFolder folder;
  const std::string here = folder.File("");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(here);
  DiskCalls().clear();
  EXPECT_TRUE(FlushFolderOf(folder.File("a.tif")).ok());
  EXPECT_TRUE(FlushFolderOf("a.tif").ok());
  std::filesystem::current_path(before);
  const std::string flushed =
      "fsync " + std::filesystem::path(here).parent_path().string();
  EXPECT_THAT(DiskCalls(), ElementsAre(flushed, flushed));
}

}  // namespace
}  // namespace terrane::client
