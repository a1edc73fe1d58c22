// What P_fbm is made to pass through, for the lattice and the line alike.
#ifndef TERRANE_CORE_TERRAIN_IMPOSED_H_
#define TERRANE_CORE_TERRAIN_IMPOSED_H_

#include <memory>

#include "core/terrain/correction_table.h"
#include "core/terrain/discrete_constraints.h"
#include "core/terrain/spot_pins.h"

namespace terrane::core {

// All may be null: nothing of the kind. Immutable and thread-safe.
struct Imposed {
  // Points that are brought to 0 with buffers around.
  std::shared_ptr<const DiscreteConstraints> constraints;
  // Displacements that are corrected for spot heights.
  std::shared_ptr<const CorrectionTable> corrections;
  // The spots themselves. Source SUCCESSIVE, which displaces every point at
  // every level, leaves them where they are.
  std::shared_ptr<const SpotPins> pins;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_IMPOSED_H_
