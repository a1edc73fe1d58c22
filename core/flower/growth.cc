#include "core/flower/growth.h"

#include <algorithm>
#include <cmath>

namespace terrane::core {
namespace {

double Mix(double a, double b, double share) { return a + share * (b - a); }

double VogelRadius(const Arrangement& arrangement, double n) {
  return arrangement.radius + arrangement.spacing * std::sqrt(n);
}

}  // namespace

GrowthStage StageAt(const GrowthStage& early, const GrowthStage& full,
                    double stage) {
  return {Mix(early.buds, full.buds, stage),
          Mix(early.angle_ratio, full.angle_ratio, stage),
          Mix(early.size, full.size, stage),
          Mix(early.spread, full.spread, stage)};
}

double Openness(const GrowthStage& stage, double n, double count) {
  if (n <= stage.buds) return 0;
  return stage.angle_ratio * (n - stage.buds) / (count - stage.buds);
}

Seat SeatOf(const Arrangement& arrangement, int n, int count, double spread) {
  Seat seat;
  double rim = 0;
  if (arrangement.kind == ArrangementKind::kVogel) {
    seat.azimuth_deg = n * arrangement.divergence_deg;
    seat.radius = VogelRadius(arrangement, n);
    rim = VogelRadius(arrangement, count);
    if (count > 1) seat.share = (n - 1.0) / (count - 1.0);
    seat.rank = n;
  } else {
    const int layers = std::min(arrangement.layers, count);
    const int of_layer = (count + layers - 1) / layers;
    const int layer = (n - 1) / of_layer;
    const double step = arrangement.arc_deg / of_layer;
    seat.azimuth_deg = step * ((n - 1) % of_layer + 0.5 * layer);
    seat.radius = arrangement.radius + arrangement.spacing * (layer + 1);
    rim = arrangement.radius + arrangement.spacing * layers;
    if (layers > 1) seat.share = layer / (layers - 1.0);
    seat.rank = std::min(count, (layer + 1) * of_layer);
  }
  const double ratio = rim > 0 ? seat.radius / rim : 0;
  seat.height =
      spread * (arrangement.height + arrangement.dome * (1 - ratio * ratio));
  seat.radius *= spread;
  seat.azimuth_deg += arrangement.phase_deg;
  return seat;
}

}  // namespace terrane::core
