#include "server/actor/presets.h"

#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>

#include "server/actor/embedded_presets.h"
#include "server/actor/error_reason.h"

namespace terrane::server {
namespace {

std::map<std::string, v1::TerrainPreset> ParsePresets() {
  std::map<std::string, v1::TerrainPreset> presets;
  for (const EmbeddedPreset& embedded : EmbeddedPresets()) {
    v1::TerrainPreset preset;
    const auto parsed =
        google::protobuf::util::JsonStringToMessage(embedded.json, &preset);
    GOOGLE_CHECK(parsed.ok()) << embedded.name << ": " << parsed.ToString();
    GOOGLE_CHECK(preset.name() == embedded.name)
        << embedded.name << " is called " << preset.name();
    presets.emplace(embedded.name, std::move(preset));
  }
  return presets;
}

}  // namespace

const std::map<std::string, v1::TerrainPreset>& Presets() {
  static const auto* const presets =
      new std::map<std::string, v1::TerrainPreset>(ParsePresets());
  return *presets;
}

absl::StatusOr<const v1::TerrainPreset*> FindPreset(const std::string& name) {
  const auto found = Presets().find(name);
  if (found != Presets().end()) return &found->second;
  return NotFoundError("no preset is called \"" + name + "\"",
                       {std::string(kPresetNotFound), "preset", name});
}

}  // namespace terrane::server
