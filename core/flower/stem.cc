#include "core/flower/stem.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/mesh/float3.h"

namespace terrane::core {
namespace {

// Waves of the perturbation along a stem, and the noise's share of the bend: an
// rms slope of 0.217 over half a wave moves the tip by about the bend.
constexpr float kWaves = 2;
constexpr double kGain = 8;
// Where the tip begins to nod.
constexpr double kNodFrom = 0.75;

// The whole lattice rows that the two directions of a variant lie on.
float NoiseRow(int variant, int direction) {
  return static_cast<float>(16 * variant + 8 * direction);
}

Vector DirectionAt(const StemSpec& spec, int variant, double share,
                   const PerlinNoise& noise) {
  const float along = kWaves * static_cast<float>(share);
  const double slope = kGain * spec.bend;
  const double x =
      static_cast<double>(noise.At(along, NoiseRow(variant, 0)).value);
  const double y =
      static_cast<double>(noise.At(along, NoiseRow(variant, 1)).value);
  const double t = std::clamp((share - kNodFrom) / (1 - kNodFrom), 0.0, 1.0);
  const Turn nod = AboutX(spec.nod_deg * t * t * (3 - 2 * t));
  return UnitOf(nod.Of({slope * x, slope * y, 1}));
}

Vector CrossOf(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Rings of a tube whose frames do not twist.
class TubeWriter {
 public:
  TubeWriter(const StemSpec& spec, Mesh* mesh) : spec_(spec), mesh_(*mesh) {
    for (int k = 0; k <= spec.sides; ++k) {
      circle_.push_back(
          SineCosineOf(k == spec.sides ? 0 : 360.0 * k / spec.sides));
    }
  }

  void AddRing(const StemLine::Place& place, double share) {
    // The frame before it, turned as little as the direction asks.
    const Vector d = place.direction;
    const double along = side_.x * d.x + side_.y * d.y + side_.z * d.z;
    side_ = UnitOf(side_ + -along * d);
    const Vector front = CrossOf(d, side_);
    const double radius = StemRadius(spec_, share);
    for (std::size_t k = 0; k < circle_.size(); ++k) {
      const Vector out = circle_[k].cosine * side_ + circle_[k].sine * front;
      Add(place.position + radius * out, out,
          {static_cast<float>(k) / static_cast<float>(spec_.sides),
           static_cast<float>(share)});
    }
  }

  // Closes the ring that was added last: seen along `out`.
  void AddCap(const StemLine::Place& place, bool above) {
    const auto ring =
        static_cast<std::uint32_t>(mesh_.positions.size() - circle_.size());
    const Vector out = (above ? 1.0 : -1.0) * place.direction;
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (std::uint32_t k = ring; k < first; ++k) {
      mesh_.positions.push_back(mesh_.positions[k]);
      mesh_.normals.push_back(ToFloat3(out));
      mesh_.uvs.push_back(mesh_.uvs[k]);
    }
    Add(place.position, out, {0.5f, above ? 1.0f : 0.0f});
    const auto middle = static_cast<std::uint32_t>(mesh_.positions.size()) - 1;
    for (std::uint32_t k = first; k + 1 < middle; ++k) {
      if (above) {
        AddTriangle(k, k + 1, middle);
      } else {
        AddTriangle(k + 1, k, middle);
      }
    }
  }

  void Connect(std::uint32_t low, std::uint32_t high) {
    for (std::uint32_t k = 0; k + 1 < circle_.size(); ++k) {
      AddTriangle(low + k, low + k + 1, high + k);
      AddTriangle(low + k + 1, high + k + 1, high + k);
    }
  }

 private:
  void Add(Vector position, Vector normal, Float2 uv) {
    mesh_.positions.push_back(ToFloat3(position));
    mesh_.normals.push_back(ToFloat3(normal));
    mesh_.uvs.push_back(uv);
  }
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.indices.push_back(a);
    mesh_.indices.push_back(b);
    mesh_.indices.push_back(c);
  }

  const StemSpec& spec_;
  Mesh& mesh_;
  std::vector<SineCosine64> circle_;
  Vector side_ = {1, 0, 0};
};

}  // namespace

StemLine::StemLine(const StemSpec& spec, int variant,
                   const PerlinNoise& noise) {
  const double step = 1.0 / spec.rows;
  Vector position;
  for (int i = 0; i <= spec.rows; ++i) {
    places_.push_back({position, DirectionAt(spec, variant, i * step, noise)});
    position =
        position + spec.height * step *
                       DirectionAt(spec, variant, (i + 0.5) * step, noise);
  }
}

StemLine::Place StemLine::At(double share) const {
  const auto last = static_cast<double>(places_.size() - 1);
  const double at = std::clamp(share, 0.0, 1.0) * last;
  const double low = std::min(std::floor(at), last - 1);
  const Place& a = places_[static_cast<std::size_t>(low)];
  const Place& b = places_[static_cast<std::size_t>(low) + 1];
  const double rest = at - low;
  return {(1 - rest) * a.position + rest * b.position,
          UnitOf((1 - rest) * a.direction + rest * b.direction)};
}

double StemRadius(const StemSpec& spec, double share) {
  return spec.radius * (1 + (spec.taper - 1) * share);
}

Mesh MakeStem(const StemSpec& spec, const StemLine& line) {
  Mesh mesh;
  TubeWriter writer(spec, &mesh);
  const std::vector<StemLine::Place>& places = line.places();
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    writer.AddRing(places[i],
                   static_cast<double>(i) / static_cast<double>(spec.rows));
    if (i > 0) writer.Connect(before, first);
    before = first;
    if (i == 0) writer.AddCap(places[i], false);
    if (i + 1 == places.size()) writer.AddCap(places[i], true);
  }
  return mesh;
}

MeshSize StemSize(const StemSpec& spec) {
  const std::int64_t ring = spec.sides + 1;
  const std::int64_t rows = spec.rows;
  return {ring * (rows + 3) + 2, spec.sides * (2 * rows + 2)};
}

}  // namespace terrane::core
