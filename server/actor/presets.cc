#include "server/actor/presets.h"

#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>

#include <optional>
#include <string_view>

#include "server/actor/embedded_presets.h"
#include "server/actor/error_reason.h"

namespace terrane::server {
namespace {

// Folders of presets that are no terrains.
constexpr std::string_view kSurfaceFolder = "surface/";
constexpr std::string_view kTreeFolder = "tree/";
constexpr std::string_view kFlowerFolder = "flower/";

bool IsTerrain(std::string_view name) {
  for (const std::string_view folder :
       {kSurfaceFolder, kTreeFolder, kFlowerFolder}) {
    if (name.starts_with(folder)) return false;
  }
  return true;
}

// Those in `folder`, or the terrains without one.
template <typename Preset>
std::map<std::string, Preset> ParsePresets(
    std::optional<std::string_view> folder) {
  std::map<std::string, Preset> presets;
  for (const EmbeddedPreset& embedded : EmbeddedPresets()) {
    const std::string_view name = embedded.name;
    const bool wanted =
        folder.has_value() ? name.starts_with(*folder) : IsTerrain(name);
    if (!wanted) continue;
    Preset preset;
    const auto parsed =
        google::protobuf::util::JsonStringToMessage(embedded.json, &preset);
    GOOGLE_CHECK(parsed.ok()) << embedded.name << ": " << parsed.ToString();
    GOOGLE_CHECK(preset.name() == embedded.name)
        << embedded.name << " is called " << preset.name();
    presets.emplace(embedded.name, std::move(preset));
  }
  return presets;
}

template <typename Preset>
absl::StatusOr<const Preset*> Find(const std::map<std::string, Preset>& presets,
                                   const std::string& name) {
  const auto found = presets.find(name);
  if (found != presets.end()) return &found->second;
  return NotFoundError("no preset is called \"" + name + "\"",
                       {std::string(kPresetNotFound), "preset", name});
}

}  // namespace

const std::map<std::string, v1::TerrainPreset>& Presets() {
  static const auto* const presets =
      new std::map<std::string, v1::TerrainPreset>(
          ParsePresets<v1::TerrainPreset>(std::nullopt));
  return *presets;
}

const std::map<std::string, v1::SurfacePreset>& SurfacePresets() {
  static const auto* const presets =
      new std::map<std::string, v1::SurfacePreset>(
          ParsePresets<v1::SurfacePreset>(kSurfaceFolder));
  return *presets;
}

const std::map<std::string, v1::TreePreset>& TreePresets() {
  static const auto* const presets = new std::map<std::string, v1::TreePreset>(
      ParsePresets<v1::TreePreset>(kTreeFolder));
  return *presets;
}

const std::map<std::string, v1::FlowerPreset>& FlowerPresets() {
  static const auto* const presets =
      new std::map<std::string, v1::FlowerPreset>(
          ParsePresets<v1::FlowerPreset>(kFlowerFolder));
  return *presets;
}

absl::StatusOr<const v1::TerrainPreset*> FindPreset(const std::string& name) {
  return Find(Presets(), name);
}

absl::StatusOr<const v1::SurfacePreset*> FindSurfacePreset(
    const std::string& name) {
  return Find(SurfacePresets(), name);
}

absl::StatusOr<const v1::TreePreset*> FindTreePreset(const std::string& name) {
  return Find(TreePresets(), name);
}

absl::StatusOr<const v1::FlowerPreset*> FindFlowerPreset(
    const std::string& name) {
  return Find(FlowerPresets(), name);
}

}  // namespace terrane::server
