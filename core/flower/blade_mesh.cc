#include "core/flower/blade_mesh.h"

#include <cstddef>
#include <memory>
#include <optional>

#include "core/flower/bezier_rows.h"
#include "core/flower/blade_outline.h"
#include "core/flower/blade_painter.h"
#include "core/flower/ifs_rows.h"
#include "core/noise/counter_hash.h"

namespace terrane::core {
namespace {

constexpr std::uint32_t kOffsetStream = 0x4F464653;

double Mix(double a, double b, double share) { return a + share * (b - a); }

// Rows become a mesh.
class BladeWriter {
 public:
  BladeWriter(const BladeSpec& blade, double widest, const PerlinNoise& noise,
              Mesh* mesh)
      : blade_(blade), widest_(static_cast<float>(widest)), mesh_(*mesh) {
    const auto count = static_cast<std::size_t>(blade.columns + 1) *
                           static_cast<std::size_t>(blade.rows - 1) +
                       2;
    mesh_.positions.reserve(count);
    mesh_.normals.reserve(count);
    mesh_.uvs.reserve(count);
    if (HasColors(blade.colors)) {
      painter_.emplace(blade.colors, noise);
      mesh_.colors.reserve(count);
    }
  }

  void Add(const BladeRow& row) {
    mesh_.positions.insert(mesh_.positions.end(), row.positions.begin(),
                           row.positions.end());
    mesh_.normals.insert(mesh_.normals.end(), row.normals.begin(),
                         row.normals.end());
    const std::size_t first = mesh_.uvs.size();
    const std::size_t count = row.positions.size();
    mesh_.uvs.resize(first + count);
    Float2* const uvs = mesh_.uvs.data() + first;
    const float step =
        count > 1 ? 2.0f * row.half_width / static_cast<float>(count - 1)
                  : 0.0f;
    const float left = count > 1 ? row.half_width : 0.0f;
    const float scale = 0.5f / widest_;
    for (std::size_t k = 0; k < count; ++k) {
      const float x = step * static_cast<float>(k) - left;
      uvs[k] = {0.5f + scale * x, row.y};
    }
    if (!painter_) return;
    for (std::size_t k = 0; k < count; ++k) {
      const float x = step * static_cast<float>(k) - left;
      mesh_.colors.push_back(painter_->At(x, row.y, row.half_width));
    }
  }

  void Connect() {
    const auto row = static_cast<std::uint32_t>(blade_.columns) + 1;
    const auto inner_rows = static_cast<std::uint32_t>(blade_.rows) - 1;
    const std::uint32_t tip = 1 + row * inner_rows;
    mesh_.indices.resize(std::size_t{6} * (row - 1) * inner_rows);
    std::uint32_t* next = mesh_.indices.data();
    const auto add = [&next](std::uint32_t a, std::uint32_t b,
                             std::uint32_t c) {
      next[0] = a;
      next[1] = b;
      next[2] = c;
      next += 3;
    };
    for (std::uint32_t k = 1; k < row; ++k) add(0, k + 1, k);
    for (std::uint32_t j = 1; j < inner_rows; ++j) {
      for (std::uint32_t k = 0; k + 1 < row; ++k) {
        const std::uint32_t below = 1 + (j - 1) * row + k;
        add(below, below + 1, below + row);
        add(below + 1, below + row + 1, below + row);
      }
    }
    for (std::uint32_t k = tip - row; k + 1 < tip; ++k) add(k, k + 1, tip);
  }

 private:
  const BladeSpec& blade_;
  const float widest_;
  std::optional<BladePainter> painter_;
  Mesh& mesh_;
};

std::unique_ptr<BladeSurface> MakeSurface(
    PetalMethod method, const BladeSpec& blade, const BladeChoice& choice,
    const BladeOutline& outline, std::int64_t seed, LatticeOffset offset,
    const PerlinNoise& noise) {
  const Sketch& sketch =
      blade.sketches[static_cast<std::size_t>(choice.sketch)];
  if (method == PetalMethod::kIfs) {
    return std::make_unique<IfsRows>(IfsCode(sketch), blade.rows,
                                     outline.spans(), seed);
  }
  auto petal = std::make_unique<BladeRows>(noise, outline, blade.relief,
                                           ShapeAt(blade, choice.step), offset);
  if (method == PetalMethod::kPerlin) return petal;
  return std::make_unique<BezierRows>(outline,
                                      FitBezierNet(outline, petal.get()));
}

}  // namespace

LatticeOffset OffsetOf(std::int64_t seed, std::uint32_t salt,
                       const BladeChoice& choice) {
  const RowKey key = MakeRowKey(StreamKey(seed, kOffsetStream), salt);
  const std::uint32_t word =
      HashLane(ColumnWord(choice.sketch * 1024 + choice.variant), key);
  return {static_cast<int>(word & 0xFFu),
          static_cast<int>((word >> 8) & 0xFFu)};
}

BladeShape ShapeAt(const BladeSpec& blade, int step) {
  if (blade.steps == 1) return blade.open;
  const double share = static_cast<double>(step) / (blade.steps - 1);
  const BladeShape& a = blade.closed;
  const BladeShape& b = blade.open;
  return {Mix(a.across_deg, b.across_deg, share),
          Mix(a.base_curl_deg, b.base_curl_deg, share),
          Mix(a.tip_curl_deg, b.tip_curl_deg, share),
          Mix(a.flare, b.flare, share), Mix(a.relief, b.relief, share)};
}

MeshSize BladeSize(const BladeSpec& blade) {
  const std::int64_t columns = blade.columns;
  const std::int64_t rows = blade.rows;
  return {(columns + 1) * (rows - 1) + 2, 2 * columns * (rows - 1)};
}

Mesh MakeBladeMesh(PetalMethod method, const BladeSpec& blade,
                   const BladeChoice& choice, std::int64_t seed,
                   std::uint32_t salt, const PerlinNoise& noise,
                   const std::stop_token& stop) {
  const BladeOutline outline(
      blade.sketches[static_cast<std::size_t>(choice.sketch)]);
  const std::unique_ptr<BladeSurface> surface =
      MakeSurface(method, blade, choice, outline, seed,
                  OffsetOf(seed, salt, choice), noise);
  Mesh mesh;
  BladeWriter writer(blade, outline.widest(), noise, &mesh);
  BladeRow row;
  for (int j = 0; j <= blade.rows; ++j) {
    if (stop.stop_requested()) return mesh;
    surface->Make(outline.spans() * (static_cast<double>(j) / blade.rows),
                  blade.columns, &row);
    writer.Add(row);
  }
  writer.Connect();
  return mesh;
}

double NormalVariance(const PerlinNoise& noise, const Sketch& sketch,
                      const Relief& relief, LatticeOffset offset) {
  constexpr int kColumns = 32;
  constexpr int kRows = 64;
  const BladeOutline outline(sketch);
  BladeRows rows(noise, outline, relief, BladeShape{}, offset);
  BladeRow row;
  double x = 0, y = 0, z = 0, area = 0;
  double before = 0;
  for (int j = 1; j < kRows; ++j) {
    rows.Make(outline.spans() * (static_cast<double>(j) / kRows), kColumns,
              &row);
    const double cell = (static_cast<double>(row.y) - before) *
                        static_cast<double>(row.half_width);
    before = static_cast<double>(row.y);
    for (const Float3& normal : row.normals) {
      const double weight = cell / static_cast<double>(normal.z);
      x += weight * static_cast<double>(normal.x);
      y += weight * static_cast<double>(normal.y);
      z += weight * static_cast<double>(normal.z);
      area += weight;
    }
  }
  return 1 - (x * x + y * y + z * z) / (area * area);
}

int ControlValues(PetalMethod method, const Sketch& sketch) {
  switch (method) {
    case PetalMethod::kIfs:
      return 6 * static_cast<int>(IfsCode(sketch).size());
    case PetalMethod::kBezier:
      return 3 * 16;
    case PetalMethod::kPerlin:
      break;
  }
  constexpr int kOfRelief = 3;  // Nd, Nsx, Nsy
  return 2 * static_cast<int>(sketch.points.size()) + kOfRelief;
}

}  // namespace terrane::core
