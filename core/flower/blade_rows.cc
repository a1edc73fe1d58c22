#include "core/flower/blade_rows.h"

#include <array>
#include <cmath>

#include "core/base/det_math.h"
#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

constexpr double kRadians = 0.017453292519943295;

// sin(a) / a and (1 - cos(a)) / a^2 as functions of a^2, |a| <= pi: Taylor to
// a^16 leaves less than 2^-21.
constexpr float SineShare(float square) {
  float sum = 2.8114573e-15f;
  for (const float factor :
       {-7.6471637e-13f, 1.6059044e-10f, -2.5052108e-8f, 2.7557319e-6f,
        -1.9841270e-4f, 8.3333333e-3f, -1.6666667e-1f, 1.0f}) {
    sum = sum * square + factor;
  }
  return sum;
}
constexpr float VersineShare(float square) {
  float sum = 1.5619207e-16f;
  for (const float factor :
       {-4.7794773e-14f, 1.1470746e-11f, -2.0876757e-9f, 2.7557319e-7f,
        -2.4801587e-5f, 1.3888889e-3f, -4.1666667e-2f, 0.5f}) {
    sum = sum * square + factor;
  }
  return sum;
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
      height_(static_cast<float>(relief.gain * relief.amplitude)),
      flare_(static_cast<float>(shape.flare)),
      widest_(static_cast<float>(outline.widest())),
      farthest_(static_cast<float>(outline.farthest())),
      across_(static_cast<float>(shape.across_deg * kRadians)),
      base_curl_(shape.base_curl_deg * kRadians),
      curl_change_((shape.tip_curl_deg - shape.base_curl_deg) * kRadians) {
  midline_.curvature = base_curl_;
}

void BladeRows::Columns::Resize(std::size_t count) {
  x.resize(count);
  cell.resize(count);
  left.resize(count);
  right.resize(count);
  depth.resize(count);
  depth_dx.resize(count);
  depth_dy.resize(count);
  positions.resize(count);
  normals.resize(count);
}

void BladeRows::Make(double t, int columns, BladeRow* row) {
  const SketchPoint edge = outline_.At(t);
  const bool is_point = t <= 0 || t >= outline_.spans();
  const int half = is_point ? 0 : columns / 2;
  row->y = static_cast<float>(edge.y);
  row->half_width = is_point ? 0.0f : static_cast<float>(edge.x);
  MoveTo(edge.y);
  // Of a mirrored sheet the right half is enough.
  const int first = mirrored_ ? 0 : -half;
  const auto count = static_cast<std::size_t>(half - first + 1);
  columns_.Resize(count);
  PlaceColumns(row->y, row->half_width, first, half);
  RaiseColumns(row->y, count);
  BendColumns(count);
  Store(half, row);
}

double BladeRows::Theta(double y) const {
  return (base_curl_ + 0.5 * curl_change_ * y) * y;
}

void BladeRows::MoveTo(double y) {
  const double step = y - midline_.y;
  if (base_curl_ == 0 && curl_change_ == 0) {
    midline_.out = y;
  } else if (step > 0) {
    // Gauss's rule of 3 points.
    constexpr double kNode = 0.7745966692414834;
    constexpr double kOuter = 5.0 / 18;
    constexpr double kInner = 8.0 / 18;
    const double middle = midline_.y + 0.5 * step;
    const std::array<double, 3> thetas = {Theta(middle - 0.5 * step * kNode),
                                          Theta(middle),
                                          Theta(middle + 0.5 * step * kNode)};
    midline_.out +=
        step * (kOuter * DetCos(thetas[0]) + kInner * DetCos(thetas[1]) +
                kOuter * DetCos(thetas[2]));
    midline_.up +=
        step * (kOuter * DetSin(thetas[0]) + kInner * DetSin(thetas[1]) +
                kOuter * DetSin(thetas[2]));
    midline_.sine = DetSin(Theta(y));
    midline_.cosine = DetCos(Theta(y));
  }
  midline_.curvature = base_curl_ + curl_change_ * y;
  midline_.y = y;
}

void BladeRows::PlaceColumns(float y, float half_width, int first, int half) {
  const float noise_y = frequency_y_ * y;
  const float bottom = std::floor(noise_y);
  const int j = offset_.y + static_cast<int>(bottom);
  const float step = half > 0 ? half_width / static_cast<float>(half) : 0.0f;
  float left = 0;
  LatticeColumn at_left;
  LatticeColumn at_right;
  for (int k = first; k <= half; ++k) {
    const auto at = static_cast<std::size_t>(k - first);
    const float x = k == half    ? half_width
                    : k == -half ? -half_width
                                 : step * static_cast<float>(k);
    const float noise_x = frequency_x_ * x;
    const float column = std::floor(noise_x);
    if (k == first || column != left) {
      left = column;
      const int i = offset_.x + static_cast<int>(column);
      at_left = noise_.ColumnAt(i, j, noise_y - bottom);
      at_right = noise_.ColumnAt(i + 1, j, noise_y - bottom);
    }
    columns_.x[at] = x;
    columns_.cell[at] = noise_x - column;
    columns_.left[at] = at_left;
    columns_.right[at] = at_right;
  }
}

void BladeRows::RaiseColumns(float y, std::size_t count) {
  const float slope_x = height_ * frequency_x_;
  const float slope_y = height_ * frequency_y_;
  const float of_square = 1.0f / (widest_ * widest_ * farthest_);
  const float along = y * y / farthest_;
  const float along_dy = 2.0f * y / farthest_;
  for (std::size_t k = 0; k < count; ++k) {
    const NoiseSample noise =
        NoiseBetween(columns_.left[k], columns_.right[k], columns_.cell[k]);
    const float x = columns_.x[k];
    const float s = x * x * of_square + along;
    const float lean = flare_ * (s * s);
    columns_.depth[k] = height_ * noise.value - lean * s;
    columns_.depth_dx[k] = slope_x * noise.dx - 6.0f * lean * (x * of_square);
    columns_.depth_dy[k] = slope_y * noise.dy - 3.0f * lean * along_dy;
  }
  // The ridge of a mirrored sheet has the mean of its two slopes.
  if (mirrored_) columns_.depth_dx[0] = 0;
}

void BladeRows::BendColumns(std::size_t count) {
  const auto sine = static_cast<float>(midline_.sine);
  const auto cosine = static_cast<float>(midline_.cosine);
  const auto out = static_cast<float>(midline_.out);
  const auto up = static_cast<float>(midline_.up);
  const auto curvature = static_cast<float>(midline_.curvature);
  for (std::size_t k = 0; k < count; ++k) {
    const float x = columns_.x[k];
    const float z = columns_.depth[k];
    const float z_dx = columns_.depth_dx[k];
    const float z_dy = columns_.depth_dy[k];
    const float alpha = across_ * x;
    const float square = alpha * alpha;
    const float sine_share = SineShare(square);
    const float versine_share = VersineShare(square);
    const float s = alpha * sine_share;
    const float c = 1.0f - square * versine_share;
    // In the frame of X, the midline's direction and its normal n.
    const float side = x * sine_share - z * s;
    const float above = alpha * x * versine_share + z * c;
    const float stretch = 1.0f - across_ * z;
    const float side_dx = stretch * c - z_dx * s;
    const float above_dx = stretch * s + z_dx * c;
    const float side_dy = -(z_dy * s);
    const float above_dy = z_dy * c;
    const float along_dy = 1.0f - curvature * above;
    columns_.positions[k] = {side, out - sine * above, up + cosine * above};
    const float normal_x = -(above_dx * along_dy);
    const float normal_along = above_dx * side_dy - side_dx * above_dy;
    const float normal_up = side_dx * along_dy;
    const float scale =
        1.0f / std::sqrt(normal_x * normal_x + normal_along * normal_along +
                         normal_up * normal_up);
    columns_.normals[k] = {scale * normal_x,
                           scale * (cosine * normal_along - sine * normal_up),
                           scale * (sine * normal_along + cosine * normal_up)};
  }
}

void BladeRows::Store(int half, BladeRow* row) const {
  if (!mirrored_) {
    row->positions = columns_.positions;
    row->normals = columns_.normals;
    return;
  }
  const auto middle = static_cast<std::size_t>(half);
  row->positions.resize(2 * middle + 1);
  row->normals.resize(2 * middle + 1);
  for (std::size_t k = 0; k <= middle; ++k) {
    const Float3 p = columns_.positions[k];
    const Float3 n = columns_.normals[k];
    row->positions[middle - k] = {-p.x, p.y, p.z};
    row->normals[middle - k] = {-n.x, n.y, n.z};
    row->positions[middle + k] = p;
    row->normals[middle + k] = n;
  }
}

}  // namespace terrane::core
