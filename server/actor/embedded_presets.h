// The JSON of server/presets, as server/presets/embed.cmake writes it into the
// build tree.
#ifndef TERRANE_SERVER_ACTOR_EMBEDDED_PRESETS_H_
#define TERRANE_SERVER_ACTOR_EMBEDDED_PRESETS_H_

#include <span>

namespace terrane::server {

struct EmbeddedPreset {
  const char* name;  // path below server/presets without .json
  const char* json;
};

std::span<const EmbeddedPreset> EmbeddedPresets();

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_EMBEDDED_PRESETS_H_
