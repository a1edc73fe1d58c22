// Growth: the stage that a flower is in, and what it means for a petal.
//
// Pure functions. Source: Wang, Zhang & Yang 2019, section 3.1.
#ifndef TERRANE_CORE_FLOWER_GROWTH_H_
#define TERRANE_CORE_FLOWER_GROWTH_H_

#include "core/flower/flower_spec.h"

namespace terrane::core {

// The blend of two stages: `early` at 0, `full` at 1.
GrowthStage StageAt(const GrowthStage& early, const GrowthStage& full,
                    double stage);

// How far petal n of `count` is open, in [0, 1]: 0 for the buds, n <= Nb, and
// Sa (n - Nb) / (N - Nb) for the others.
double Openness(const GrowthStage& stage, double n, double count);

// Where an organ sits.
struct Seat {
  double azimuth_deg = 0;
  double radius = 0;
  double height = 0;
  // From the centre, 0, to the rim, 1: 1 where there is only one.
  double share = 1;
  // The n of the growth stage: of a whorl, that of its layer's last organ.
  double rank = 1;
};

// Of organ n of `count`, n from 1. `spread` multiplies radii and heights.
Seat SeatOf(const Arrangement& arrangement, int n, int count, double spread);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_GROWTH_H_
