#include "core/flower/blade_rows.h"

#include <algorithm>
#include <cmath>

#include "core/base/det_math.h"

namespace terrane::core {
namespace {

constexpr double kRadians = 0.017453292519943295;

// sin(a) / a and (1 - cos(a)) / a^2 as functions of q = a^2, |a| <= pi: Taylor
// to a^16 leaves less than 2^-21.
constexpr float SineShare(float q) {
  float sum = 2.8114573e-15f * q - 7.6471637e-13f;
  sum = sum * q + 1.6059044e-10f;
  sum = sum * q - 2.5052108e-8f;
  sum = sum * q + 2.7557319e-6f;
  sum = sum * q - 1.9841270e-4f;
  sum = sum * q + 8.3333333e-3f;
  sum = sum * q - 1.6666667e-1f;
  return sum * q + 1.0f;
}
constexpr float VersineShare(float q) {
  float sum = 1.5619207e-16f * q - 4.7794773e-14f;
  sum = sum * q + 1.1470746e-11f;
  sum = sum * q - 2.0876757e-9f;
  sum = sum * q + 2.7557319e-7f;
  sum = sum * q - 2.4801587e-5f;
  sum = sum * q + 1.3888889e-3f;
  sum = sum * q - 4.1666667e-2f;
  return sum * q + 0.5f;
}

}  // namespace

BladeRows::BladeRows(const PerlinNoise& noise, const BladeOutline& outline,
                     const Relief& relief, const BladeShape& shape,
                     LatticeOffset offset)
    : noise_(noise),
      outline_(outline),
      offset_(offset),
      mirrored_(relief.mirrored),
      frequency_x_(static_cast<float>(relief.frequency_x)),
      frequency_y_(static_cast<float>(relief.frequency_y)),
      height_(
          static_cast<float>(relief.gain * relief.amplitude * shape.relief)),
      flare_(static_cast<float>(shape.flare)),
      widest_(static_cast<float>(outline.widest())),
      farthest_(static_cast<float>(outline.farthest())),
      across_(static_cast<float>(shape.across_deg * kRadians)),
      base_curl_(shape.base_curl_deg * kRadians),
      curl_change_((shape.tip_curl_deg - shape.base_curl_deg) * kRadians) {
  midline_.curvature = base_curl_;
}

void BladeRows::Make(double t, int columns, BladeRow* row) {
  const SketchPoint edge = outline_.At(t);
  const bool is_point = t <= 0 || t >= outline_.spans();
  const int half = is_point ? 0 : columns / 2;
  row->y = static_cast<float>(edge.y);
  row->half_width = is_point ? 0.0f : static_cast<float>(edge.x);
  row->positions.resize(static_cast<std::size_t>(2 * half + 1));
  row->normals.resize(row->positions.size());
  MoveTo(edge.y);
  NoiseLine line = LineAt(row->y);
  const float step =
      half > 0 ? row->half_width / static_cast<float>(half) : 0.0f;
  // Of a mirrored sheet the right half is enough.
  const int first = mirrored_ ? 0 : -half;
  for (int k = first; k <= half; k += static_cast<int>(kLanes)) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // Lanes behind the row repeat its last vertex.
      const int at = std::min(k + static_cast<int>(lane), half);
      const float x = std::copysign(row->half_width, static_cast<float>(at));
      Place(at == half || at == -half ? x : step * static_cast<float>(at), lane,
            &line);
    }
    Raise(row->y);
    // The ridge of a mirrored sheet has the mean of its two slopes.
    if (mirrored_ && k == 0) lanes_.depth_dx[0] = 0;
    Bend();
    Store(k, half, row);
  }
}

double BladeRows::Theta(double y) const {
  return (base_curl_ + 0.5 * curl_change_ * y) * y;
}

void BladeRows::MoveTo(double y) {
  const double step = y - midline_.y;
  if (base_curl_ == 0 && curl_change_ == 0) {
    midline_.out = y;
  } else if (step > 0) {
    // Gauss's rule of 2 points.
    const double reach = 0.28867513459481287 * step;
    const double middle = midline_.y + 0.5 * step;
    const SineCosine64 low = DetSinCos(Theta(middle - reach));
    const SineCosine64 high = DetSinCos(Theta(middle + reach));
    const SineCosine64 end = DetSinCos(Theta(y));
    midline_.out += 0.5 * step * (low.cosine + high.cosine);
    midline_.up += 0.5 * step * (low.sine + high.sine);
    midline_.sine = end.sine;
    midline_.cosine = end.cosine;
  }
  midline_.curvature = base_curl_ + curl_change_ * y;
  midline_.y = y;
}

BladeRows::NoiseLine BladeRows::LineAt(float y) const {
  const float noise_y = frequency_y_ * y;
  const float bottom = std::floor(noise_y);
  NoiseLine line;
  line.y_rest = noise_y - bottom;
  line.j = offset_.y + static_cast<int>(bottom);
  return line;
}

void BladeRows::Place(float x, std::size_t lane, NoiseLine* line) {
  const float noise_x = frequency_x_ * x;
  const int whole = static_cast<int>(noise_x);
  const int column = whole - (noise_x < static_cast<float>(whole) ? 1 : 0);
  if (!line->found || column != line->column) {
    const int i = offset_.x + column;
    line->found = true;
    line->column = column;
    line->left = noise_.ColumnAt(i, line->j, line->y_rest);
    line->right = noise_.ColumnAt(i + 1, line->j, line->y_rest);
  }
  lanes_.x[lane] = x;
  lanes_.cell[lane] = noise_x - static_cast<float>(column);
  lanes_.left_slope[lane] = line->left.slope;
  lanes_.left_level[lane] = line->left.level;
  lanes_.left_slope_dy[lane] = line->left.slope_dy;
  lanes_.left_level_dy[lane] = line->left.level_dy;
  lanes_.right_slope[lane] = line->right.slope;
  lanes_.right_level[lane] = line->right.level;
  lanes_.right_slope_dy[lane] = line->right.slope_dy;
  lanes_.right_level_dy[lane] = line->right.level_dy;
}

void BladeRows::Raise(float y) {
  const float height = height_;
  const float flare = flare_;
  const float slope_x = height_ * frequency_x_;
  const float slope_y = height_ * frequency_y_;
  const float of_square = 1.0f / (widest_ * widest_ * farthest_);
  const float along = y * y / farthest_;
  const float along_dy = 2.0f * y / farthest_;
  for (std::size_t k = 0; k < kLanes; ++k) {
    const NoiseSample noise =
        NoiseBetween({lanes_.left_slope[k], lanes_.left_level[k],
                      lanes_.left_slope_dy[k], lanes_.left_level_dy[k]},
                     {lanes_.right_slope[k], lanes_.right_level[k],
                      lanes_.right_slope_dy[k], lanes_.right_level_dy[k]},
                     lanes_.cell[k]);
    const float x = lanes_.x[k];
    const float s = x * x * of_square + along;
    const float lean = flare * (s * s);
    lanes_.depth[k] = height * noise.value - lean * s;
    lanes_.depth_dx[k] = slope_x * noise.dx - 6.0f * lean * (x * of_square);
    lanes_.depth_dy[k] = slope_y * noise.dy - 3.0f * lean * along_dy;
  }
}

void BladeRows::Bend() {
  const float across = across_;
  const auto sine = static_cast<float>(midline_.sine);
  const auto cosine = static_cast<float>(midline_.cosine);
  const auto out = static_cast<float>(midline_.out);
  const auto up = static_cast<float>(midline_.up);
  const auto curvature = static_cast<float>(midline_.curvature);
  for (std::size_t k = 0; k < kLanes; ++k) {
    const float x = lanes_.x[k];
    const float z = lanes_.depth[k];
    const float z_dx = lanes_.depth_dx[k];
    const float z_dy = lanes_.depth_dy[k];
    const float alpha = across * x;
    const float square = alpha * alpha;
    const float sine_share = SineShare(square);
    const float versine_share = VersineShare(square);
    const float s = alpha * sine_share;
    const float c = 1.0f - square * versine_share;
    // In the frame of X, the midline's direction and its normal n.
    const float side = x * sine_share - z * s;
    const float above = alpha * x * versine_share + z * c;
    const float stretch = 1.0f - across * z;
    const float side_dx = stretch * c - z_dx * s;
    const float above_dx = stretch * s + z_dx * c;
    const float side_dy = -(z_dy * s);
    const float above_dy = z_dy * c;
    const float along_dy = 1.0f - curvature * above;
    const float normal_x = -(above_dx * along_dy);
    const float normal_along = above_dx * side_dy - side_dx * above_dy;
    const float normal_up = side_dx * along_dy;
    const float scale =
        1.0f / std::sqrt(normal_x * normal_x + normal_along * normal_along +
                         normal_up * normal_up);
    lanes_.px[k] = side;
    lanes_.py[k] = out - sine * above;
    lanes_.pz[k] = up + cosine * above;
    lanes_.nx[k] = scale * normal_x;
    lanes_.ny[k] = scale * (cosine * normal_along - sine * normal_up);
    lanes_.nz[k] = scale * (sine * normal_along + cosine * normal_up);
  }
}

void BladeRows::Store(int k, int half, BladeRow* row) const {
  const int count = std::min(static_cast<int>(kLanes), half - k + 1);
  Float3* const positions = row->positions.data() + (half + k);
  Float3* const normals = row->normals.data() + (half + k);
  for (int i = 0; i < count; ++i) {
    const auto lane = static_cast<std::size_t>(i);
    if (mirrored_) {
      const int back = -2 * k - i;
      positions[back] = {-lanes_.px[lane], lanes_.py[lane], lanes_.pz[lane]};
      normals[back] = {-lanes_.nx[lane], lanes_.ny[lane], lanes_.nz[lane]};
    }
    positions[i] = {lanes_.px[lane], lanes_.py[lane], lanes_.pz[lane]};
    normals[i] = {lanes_.nx[lane], lanes_.ny[lane], lanes_.nz[lane]};
  }
}

}  // namespace terrane::core
