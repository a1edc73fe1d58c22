// How well heights meet spots: the error of each spot, file - spot, gathered by
// class.
//
// A spot that lies on a sample (to a millionth of the spacing) is compared with
// that sample; between samples, with the bilinear interpolation of the four
// around it. Spots with a standard error are a class of their own, wherever
// they lie. Threads: any.
#ifndef TERRANE_CLIENT_SPOT_VERIFIER_H_
#define TERRANE_CLIENT_SPOT_VERIFIER_H_

#include <cstdint>

#include "client/placed_raster.h"
#include "client/spot_file.h"

namespace terrane::client {

class SpotErrors {
 public:
  void Add(double error, std::int64_t source);

  std::int64_t count() const { return count_; }
  double worst() const { return worst_; }
  // Where the worst stands in its file.
  std::int64_t worst_source() const { return worst_source_; }
  double mean_absolute() const { return Mean(sum_absolute_); }
  double root_mean_square() const;
  double bias() const { return Mean(sum_); }

 private:
  double Mean(double sum) const {
    return count_ == 0 ? 0 : sum / static_cast<double>(count_);
  }

  std::int64_t count_ = 0;
  double worst_ = 0;
  std::int64_t worst_source_ = 0;
  double sum_ = 0;
  double sum_absolute_ = 0;
  double sum_squares_ = 0;
};

struct SpotComparison {
  SpotErrors on_samples;
  SpotErrors between_samples;
  SpotErrors with_standard_error;
  // On a sample that is not the float nearest to the spot's height.
  std::int64_t not_nearest = 0;
  std::int64_t outside = 0;
  std::int64_t nodata = 0;

  std::int64_t compared() const {
    return on_samples.count() + between_samples.count() +
           with_standard_error.count();
  }
  // The largest error of all classes.
  double worst() const;
};

// The spots must be in the raster's CRS (TransformSpots). Vertices of lines
// count as spots.
SpotComparison CompareSpots(const PlacedRaster& heights, const SpotFile& spots);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_SPOT_VERIFIER_H_
