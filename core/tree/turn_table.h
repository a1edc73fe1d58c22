// Sine and cosine of an angle that is a share of a turn, 2^32 to the turn, in
// float32.
//
// A table of 256 directions and the addition theorem: a few multiplications,
// error below 2^-22, exact at quarter turns. Immutable, safe from any thread;
// the same bits everywhere.
#ifndef TERRANE_CORE_TREE_TURN_TABLE_H_
#define TERRANE_CORE_TREE_TURN_TABLE_H_

#include <array>
#include <cstdint>

namespace terrane::core {

struct SineCosine {
  float sine = 0;
  float cosine = 1;
};

class TurnTable {
 public:
  TurnTable();

  SineCosine Of(std::uint32_t turn) const {
    const SineCosine coarse = coarse_[turn >> 24];
    const float rest = static_cast<float>(turn & 0xFFFFFFu) * kRadians;
    const float square = rest * rest;
    const float sine = rest - rest * square * (1.0f / 6);
    const float cosine = 1.0f - 0.5f * square + square * square * (1.0f / 24);
    return {coarse.sine * cosine + coarse.cosine * sine,
            coarse.cosine * cosine - coarse.sine * sine};
  }

 private:
  static constexpr float kRadians = 6.283185307f / 4294967296.0f;

  std::array<SineCosine, 256> coarse_;
};

// The same of degrees, rounded from double.
SineCosine SineCosineOfDegrees(double degrees);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_TURN_TABLE_H_
