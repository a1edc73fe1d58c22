// From linear light to the 8 bits of a screen.
#ifndef TERRANE_CORE_RAYTRACE_TONE_H_
#define TERRANE_CORE_RAYTRACE_TONE_H_

#include <cstdint>
#include <span>

namespace terrane::core {

// Each value times `exposure`; what is above 0.8 then is bent below 1, so that
// highlights keep their shape: 0.8 + 0.2 y / (1 + y), y = (x - 0.8) / 0.2. Then
// sRGB's transfer function, rounded to 8 bits. Values are at least 0; as many
// bytes as values. Pure function, the same bytes everywhere.
void ToSrgb8(std::span<const float> linear, float exposure,
             std::span<std::uint8_t> bytes);

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_TONE_H_
