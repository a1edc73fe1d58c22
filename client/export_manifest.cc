#include "client/export_manifest.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <openssl/evp.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>

#include "client/output_file.h"
#include "client/tile_shard.h"

namespace terrane::client {
namespace {

using google::protobuf::util::MessageDifferencer;

absl::StatusOr<std::string> ReadWhole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError("cannot read " + path);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::string Sha256(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int size = 0;
  // Fails only when there is no memory left.
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(),
                 nullptr) != 1) {
    std::abort();
  }
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += fmt::format("{:02x}", digest[i]);
  }
  return text;
}

// What is wrong with the tiles of one manifest, in their order.
class TileList {
 public:
  TileList(const ExportManifest& manifest, const std::string& path,
           std::vector<std::string>* faults)
      : manifest_(manifest), path_(path), faults_(faults) {}

  // Error: CANCELLED when `stop` is asked for.
  absl::Status Check(const TileRun& run, std::stop_token stop) const {
    const ExportJob& job = manifest_.job();
    const auto columns = static_cast<std::int64_t>(job.tile_columns());
    const std::string folder =
        std::filesystem::path(path_).parent_path().string();
    auto tile = manifest_.tiles().begin();
    for (std::int64_t i = run.first; i < run.end; ++i) {
      if (stop.stop_requested()) return absl::CancelledError("interrupted");
      const std::int64_t row = i / columns;
      const double x = job.tile_x() + static_cast<double>(i % columns);
      const double y = job.tile_y() + static_cast<double>(row);
      if (tile == manifest_.tiles().end() || tile->x() != x || tile->y() != y) {
        Add(x, y, "is not made");
        continue;
      }
      if (!IsThere(folder, *tile)) Add(x, y, "is not there as it was made");
      ++tile;
    }
    if (tile != manifest_.tiles().end()) {
      faults_->push_back(path_ + ": holds tiles of other shards");
    }
    return absl::OkStatus();
  }

 private:
  void Add(double x, double y, const char* what) const {
    faults_->push_back(fmt::format("{}: tile {},{} {}", path_, x, y, what));
  }

  const ExportManifest& manifest_;
  const std::string& path_;
  std::vector<std::string>* const faults_;
};

// What is wrong with the job of a manifest of the export to `out`; `first` is
// that of the first of its manifests. Empty: nothing.
std::string JobFault(const ExportJob& job, const ExportJob& first,
                     const std::string& out) {
  const std::string file = std::filesystem::path(out).filename().string();
  if (job.file() != file) {
    return fmt::format("is of tiles of the name {}, not {}", job.file(), file);
  }
  if (!(job.tile_columns() >= 1 && job.tile_rows() >= 1)) {
    return "is of a job without tiles";
  }
  if (!MessageDifferencer::Equals(job, first)) {
    return "is of another job than the shard before it";
  }
  return "";
}

void Count(const ExportManifest& manifest, ExportSummary* summary) {
  for (const ExportTile& tile : manifest.tiles()) {
    for (const ExportFile& file : tile.files()) {
      summary->set_bytes(summary->bytes() + file.bytes());
    }
  }
  summary->set_kept(summary->kept() + manifest.tiles_size());
}

}  // namespace

std::string ManifestPath(const std::string& out, std::int64_t shard,
                         std::int64_t shards) {
  std::filesystem::path path(out);
  std::string name = path.filename().string();
  std::erase_if(name, [](char c) { return c == '{' || c == '}'; });
  return path
      .replace_filename(
          fmt::format("{}.shard-{}-of-{}.json", name, shard, shards))
      .string();
}

absl::StatusOr<ExportManifest> ReadManifest(const std::string& path) {
  const absl::StatusOr<std::string> text = ReadWhole(path);
  if (!text.ok()) return text.status();
  ExportManifest manifest;
  const auto status =
      google::protobuf::util::JsonStringToMessage(*text, &manifest);
  if (!status.ok()) {
    return absl::InvalidArgumentError(path + ": " +
                                      status.message().ToString());
  }
  return manifest;
}

absl::Status WriteManifest(const std::string& path,
                           const ExportManifest& manifest) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status =
      google::protobuf::util::MessageToJsonString(manifest, &text, options);
  if (!status.ok()) return absl::InternalError(status.message().ToString());
  const absl::Status written = WriteFile(path, std::as_bytes(std::span(text)));
  return written.ok() ? FlushFolderOf(path) : written;
}

absl::StatusOr<ExportFile> DescribeFile(const std::string& path) {
  const absl::StatusOr<std::string> bytes = ReadWhole(path);
  if (!bytes.ok()) return bytes.status();
  ExportFile file;
  file.set_file(std::filesystem::path(path).filename());
  file.set_bytes(static_cast<double>(bytes->size()));
  file.set_sha256(Sha256(*bytes));
  return file;
}

bool IsThere(const std::string& folder, const ExportTile& tile) {
  for (const ExportFile& file : tile.files()) {
    const absl::StatusOr<ExportFile> found =
        DescribeFile((std::filesystem::path(folder) / file.file()).string());
    if (!found.ok() || !MessageDifferencer::Equals(*found, file)) return false;
  }
  return tile.files_size() > 0;
}

absl::StatusOr<std::vector<std::string>> VerifyExport(const std::string& out,
                                                      std::int64_t shards,
                                                      std::stop_token stop,
                                                      ExportSummary* summary) {
  std::vector<std::string> faults;
  std::optional<ExportJob> job;
  for (std::int64_t shard = 0; shard < shards; ++shard) {
    const std::string path = ManifestPath(out, shard, shards);
    const absl::StatusOr<ExportManifest> manifest = ReadManifest(path);
    if (!manifest.ok()) {
      faults.emplace_back(manifest.status().message());
      continue;
    }
    summary->add_manifests(path);
    if (!job.has_value()) job = manifest->job();
    const std::string fault = JobFault(manifest->job(), *job, out);
    if (!fault.empty()) {
      faults.push_back(fmt::format("{}: {}", path, fault));
      continue;
    }
    const auto tiles =
        static_cast<std::int64_t>(job->tile_columns() * job->tile_rows());
    const std::size_t before = faults.size();
    const absl::Status checked =
        TileList(*manifest, path, &faults)
            .Check(ShardOf(tiles, shards, shard), stop);
    if (!checked.ok()) return checked;
    if (faults.size() == before) Count(*manifest, summary);
  }
  if (job.has_value()) {
    summary->set_tiles(job->tile_columns() * job->tile_rows());
    summary->set_recipe_hash(job->recipe_hash());
    summary->set_revision(job->revision());
  }
  return faults;
}

}  // namespace terrane::client
