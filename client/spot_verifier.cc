#include "client/spot_verifier.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace terrane::client {
namespace {

// Of the spacing: less apart, a spot lies on a sample.
constexpr double kOnSample = 1e-6;

// A place along one axis: on sample `index`, or `share` of the way to the next.
struct AxisPlace {
  std::int64_t index = 0;
  double share = 0;
};

// Nothing outside of the samples.
std::optional<AxisPlace> PlaceOnAxis(double position, double origin,
                                     double spacing, std::int64_t count) {
  const double place = (position - origin) / spacing;
  if (!(place >= -kOnSample) ||
      place > static_cast<double>(count - 1) + kOnSample) {
    return std::nullopt;
  }
  const double nearest = std::nearbyint(place);
  if (std::abs(place - nearest) <= kOnSample) {
    return AxisPlace{static_cast<std::int64_t>(nearest), 0};
  }
  const double below = std::floor(place);
  return AxisPlace{static_cast<std::int64_t>(below), place - below};
}

double Bilinear(const core::Raster& raster, const AxisPlace& x,
                const AxisPlace& y) {
  double height = 0;
  for (int j = 0; j <= (y.share > 0 ? 1 : 0); ++j) {
    for (int i = 0; i <= (x.share > 0 ? 1 : 0); ++i) {
      height += (i == 0 ? 1 - x.share : x.share) *
                (j == 0 ? 1 - y.share : y.share) *
                static_cast<double>(raster.At(x.index + i, y.index + j));
    }
  }
  return height;
}

// One spot against the heights.
void Compare(const core::Raster& raster, double x, double y, double spot,
             double standard_error, std::int64_t source,
             SpotComparison* result) {
  const core::Frame& frame = raster.frame;
  const auto column =
      PlaceOnAxis(x, frame.origin_x, frame.spacing_x, raster.width);
  const auto row =
      PlaceOnAxis(y, frame.origin_y, frame.spacing_y, raster.height);
  if (!column.has_value() || !row.has_value()) {
    ++result->outside;
    return;
  }
  const double height = Bilinear(raster, *column, *row);
  if (std::isnan(height)) {
    ++result->nodata;
    return;
  }
  const bool on_sample = column->share == 0 && row->share == 0;
  if (standard_error > 0) {
    result->with_standard_error.Add(height - spot, source);
  } else if (on_sample) {
    result->on_samples.Add(height - spot, source);
    if (static_cast<float>(height) != static_cast<float>(spot)) {
      ++result->not_nearest;
    }
  } else {
    result->between_samples.Add(height - spot, source);
  }
}

}  // namespace

void SpotErrors::Add(double error, std::int64_t source) {
  if (count_ == 0 || std::abs(error) > worst_) {
    worst_ = std::abs(error);
    worst_source_ = source;
  }
  ++count_;
  sum_ += error;
  sum_absolute_ += std::abs(error);
  sum_squares_ += error * error;
}

double SpotErrors::root_mean_square() const {
  return std::sqrt(Mean(sum_squares_));
}

double SpotComparison::worst() const {
  return std::max({on_samples.worst(), between_samples.worst(),
                   with_standard_error.worst()});
}

SpotComparison CompareSpots(const PlacedRaster& heights,
                            const SpotFile& spots) {
  SpotComparison result;
  const SpotTable& table = spots.table;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    Compare(heights.raster, table.x[i], table.y[i], table.height[i],
            table.standard_error.empty() ? 0 : table.standard_error[i],
            table.source[i], &result);
  }
  for (const SpotPolyline& line : spots.lines) {
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      Compare(heights.raster, line.x[i], line.y[i], line.height[i],
              line.standard_error, line.source, &result);
    }
  }
  return result;
}

}  // namespace terrane::client
