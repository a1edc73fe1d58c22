#include "client/scene_files.h"

#include <filesystem>
#include <span>

#include "absl/status/statusor.h"
#include "client/output_file.h"
#include "core/codec/obj.h"

namespace terrane::client {
namespace {

absl::Status WriteText(const std::string& path,
                       const absl::StatusOr<std::string>& text,
                       std::vector<std::string>* files) {
  if (!text.ok()) return text.status();
  files->push_back(path);
  return WriteFile(path, std::as_bytes(std::span(*text)));
}

}  // namespace

absl::Status WriteScene(const std::string& path, const core::Scene& scene,
                        const core::GlbOptions& options,
                        std::vector<std::string>* files) {
  const std::filesystem::path file(path);
  if (file.extension() == ".glb") {
    return WriteText(path, core::EncodeGlb(scene, options), files);
  }
  const std::filesystem::path library =
      std::filesystem::path(file).replace_extension(".mtl");
  const absl::Status written = WriteText(
      path, core::EncodeObj(scene, library.filename().string()), files);
  if (!written.ok()) return written;
  return WriteText(library.string(), core::EncodeMtl(scene), files);
}

}  // namespace terrane::client
