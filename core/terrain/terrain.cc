#include "core/terrain/terrain.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/det_math.h"
#include "core/base/violations.h"
#include "core/terrain/fractal_lattice.h"
#include "core/terrain/fractal_line.h"
#include "core/terrain/macro_shape.h"
#include "core/terrain/mapping_kernels.h"
#include "core/terrain/resolve.h"
#include "core/terrain/scattered.h"
#include "core/terrain/validate.h"

namespace terrane::core {
namespace {

// Largest side of a block that is generated at once: its working memory (about
// 1.5 MB) stays in the second-level cache.
constexpr std::int64_t kBlockSize = 288;

constexpr double kSqrt6 = 2.449489742783178;

// Deviations beyond this many standard deviations are rarer than one in 10^8.
constexpr double kLikelyDeviations = 6;

absl::Status Stopped() { return absl::CancelledError("generation stopped"); }

// Cuts [0, size) into equal parts of at most kBlockSize; part k of `count`.
struct Parts {
  std::int64_t size;
  std::int64_t count = (size + kBlockSize - 1) / kBlockSize;
  std::int64_t Begin(std::int64_t k) const { return size * k / count; }
};

}  // namespace

struct TileScratch::Buffers {
  FractalLattice::Scratch lattice;
  FractalLine::Scratch line;
  SampleGrid grid;
  GridBuffer fractal, macro, fidelity;
  ScatteredScratch scattered;
};

TileScratch::TileScratch() : buffers_(std::make_unique<Buffers>()) {}
TileScratch::~TileScratch() = default;
TileScratch::TileScratch(TileScratch&&) noexcept = default;
TileScratch& TileScratch::operator=(TileScratch&&) noexcept = default;

class Terrain::Impl {
 public:
  static absl::StatusOr<std::unique_ptr<const Impl>> Create(TerrainSpec spec);

  const TerrainSpec& spec() const { return resolved_.spec; }
  std::optional<Window> Extent(int level, Sampling sampling) const;
  absl::Status CheckRequest(const TileRequest& request) const;

  enum class What { kHeight, kMacro, kFractal };
  absl::Status Generate(What what, const TileRequest& request,
                        const std::stop_token& stop,
                        TileScratch::Buffers* buffers, float* out) const;
  std::int64_t GeneratedPoints(const TileRequest& request) const;
  double DeviationBoundOr(double unbounded) const;
  HeightRange LikelyRange() const;

 private:
  Impl(ResolvedSpec resolved,
       std::shared_ptr<const DiscreteConstraints> constraints);

  static std::shared_ptr<const RasterSampler> AmplitudeSampler(
      const ResolvedSpec& resolved);
  static DeviationModel::Config ModelConfig(const ResolvedSpec& resolved);
  bool GenerateBlock(What what, int level, Sampling sampling,
                     const Window& window, const std::stop_token& stop,
                     TileScratch::Buffers* buffers, float* out,
                     std::ptrdiff_t out_stride) const;
  GridView Fractal(int level, Sampling sampling, const Window& window,
                   const std::stop_token& stop,
                   TileScratch::Buffers* buffers) const;
  void MapBlock(What what, const Window& window, GridView fractal,
                const std::stop_token& stop, TileScratch::Buffers* buffers,
                float* out, std::ptrdiff_t out_stride) const;

  ResolvedSpec resolved_;
  MacroShape macro_;
  ConstraintField fidelity_;
  HeightMap map_;
  // One of the two, by dimensions.
  std::optional<FractalLattice> lattice_;
  std::optional<FractalLine> line_;
};

// --- Preparing --------------------------------------------------------------

std::shared_ptr<const RasterSampler> Terrain::Impl::AmplitudeSampler(
    const ResolvedSpec& resolved) {
  if (resolved.amplitude.empty()) return nullptr;
  return std::make_shared<const RasterSampler>(
      resolved.amplitude, resolved.spec.domain->cells_x + 1,
      resolved.spec.domain->cells_y + 1, SampleKernel::kBilinear);
}

DeviationModel::Config Terrain::Impl::ModelConfig(
    const ResolvedSpec& resolved) {
  const TerrainSpec& spec = resolved.spec;
  return {spec.source,
          spec.dimensions,
          *spec.frame,
          {spec.domain},
          *spec.roughness,
          std::make_shared<const ConstraintField>(
              spec.continuous_constraints, ConstraintQuantity::kRoughness,
              *spec.roughness, spec.dimensions),
          AmplitudeSampler(resolved)};
}

Terrain::Impl::Impl(ResolvedSpec resolved,
                    std::shared_ptr<const DiscreteConstraints> constraints)
    : resolved_(std::move(resolved)),
      macro_(spec().macro, spec().dimensions, *spec().frame),
      fidelity_(spec().continuous_constraints, ConstraintQuantity::kFidelity,
                *spec().fidelity, spec().dimensions) {
  DeviationModel model(ModelConfig(resolved_));
  const Mirror mirror = {spec().domain};
  if (spec().dimensions == 2) {
    lattice_.emplace(FractalLattice::Config{spec().seed, spec().source, mirror,
                                            spec().refinement.has_value()},
                     std::move(model), std::move(constraints));
  } else {
    line_.emplace(FractalLine::Config{spec().seed, spec().source, mirror},
                  std::move(model), std::move(constraints));
  }
  map_.mapping = spec().mapping;
  map_.inverse_soft_limit =
      spec().soft_limit ? static_cast<float>(1 / *spec().soft_limit) : 0.0f;
  map_.z = static_cast<float>(1 / (kSqrt6 + *spec().delta));
  // The square root of the float, as a sample under a constraint takes it.
  map_.deviation = std::sqrt(fidelity_.background());
}

absl::StatusOr<std::unique_ptr<const Terrain::Impl>> Terrain::Impl::Create(
    TerrainSpec spec) {
  Violations violations;
  ValidateSpec(spec, SpecLimits(), "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  absl::StatusOr<ResolvedSpec> resolved = Resolve(std::move(spec));
  if (!resolved.ok()) return resolved.status();
  absl::StatusOr<DiscreteConstraints> constraints =
      DiscreteConstraints::Create(resolved->spec, *resolved->spec.frame);
  if (!constraints.ok()) return constraints.status();
  return std::unique_ptr<const Impl>(new Impl(
      *std::move(resolved),
      std::make_shared<const DiscreteConstraints>(*std::move(constraints))));
}

// --- Requests ---------------------------------------------------------------

std::optional<Window> Terrain::Impl::Extent(int level,
                                            Sampling sampling) const {
  if (!spec().domain) return std::nullopt;
  const std::int64_t end = sampling == Sampling::kPoint ? 1 : 0;
  return Window{
      0, 0, (spec().domain->cells_x << level) + end,
      spec().dimensions == 1 ? 1 : (spec().domain->cells_y << level) + end};
}

absl::Status Terrain::Impl::CheckRequest(const TileRequest& request) const {
  Violations violations;
  if (request.level < 0 || request.level > kMaxLevel) {
    return ViolationError("level", "must be in [0, " +
                                       std::to_string(kMaxLevel) + "], got " +
                                       std::to_string(request.level));
  }
  const std::optional<Window> extent = Extent(request.level, request.sampling);
  const auto check_axis = [&](const char* first_name, const char* count_name,
                              std::int64_t first, std::int64_t count,
                              std::int64_t extent_count) {
    const std::int64_t low = extent ? 0 : -kMaxIndex;
    const std::int64_t high =
        extent ? std::min(extent_count - 1, kMaxIndex) : kMaxIndex;
    if (first < low || first > high) {
      violations.Add(first_name, "must be in [" + std::to_string(low) + ", " +
                                     std::to_string(high) + "], got " +
                                     std::to_string(first));
    } else if (count < 1 || count > high - first + 1) {
      violations.Add(count_name, "must be in [1, " +
                                     std::to_string(high - first + 1) +
                                     "], got " + std::to_string(count));
    }
  };
  const Window& window = request.window;
  check_axis("window.x", "window.width", window.x, window.width,
             extent ? extent->width : 0);
  if (spec().dimensions == 2) {
    check_axis("window.y", "window.height", window.y, window.height,
               extent ? extent->height : 0);
  } else if (window.y != 0 || window.height != 1) {
    violations.Add("window.height", "must be 1, at row 0, for a 1-D recipe");
  }
  return violations.ToStatus();
}

std::int64_t Terrain::Impl::GeneratedPoints(const TileRequest& request) const {
  const Window& window = request.window;
  if (spec().dimensions == 1) {
    return line_->PointsComputed(request.level, window.width);
  }
  const auto of_block = [&](std::int64_t width, std::int64_t height) {
    const std::int64_t area = request.sampling == Sampling::kArea ? 1 : 0;
    return lattice_->PointsComputed(request.level, width + 3 * area,
                                    height + 3 * area) +
           area * width * height;
  };
  const Parts columns = {window.width};
  const Parts rows = {window.height};
  return columns.count * rows.count *
         of_block((window.width + columns.count - 1) / columns.count,
                  (window.height + rows.count - 1) / rows.count);
}

// --- Generating -------------------------------------------------------------

absl::Status Terrain::Impl::Generate(What what, const TileRequest& request,
                                     const std::stop_token& stop,
                                     TileScratch::Buffers* buffers,
                                     float* out) const {
  absl::Status status = CheckRequest(request);
  if (!status.ok()) return status;
  const Window& window = request.window;
  const Parts columns = {window.width};
  const Parts rows = {window.height};
  for (std::int64_t q = 0; q < rows.count; ++q) {
    for (std::int64_t p = 0; p < columns.count; ++p) {
      const std::int64_t x = columns.Begin(p);
      const std::int64_t y = rows.Begin(q);
      const Window block = {window.x + x, window.y + y,
                            columns.Begin(p + 1) - x, rows.Begin(q + 1) - y};
      if (!GenerateBlock(what, request.level, request.sampling, block, stop,
                         buffers, out + y * window.width + x, window.width)) {
        return Stopped();
      }
    }
  }
  return absl::OkStatus();
}

bool Terrain::Impl::GenerateBlock(What what, int level, Sampling sampling,
                                  const Window& window,
                                  const std::stop_token& stop,
                                  TileScratch::Buffers* buffers, float* out,
                                  std::ptrdiff_t out_stride) const {
  if (sampling == Sampling::kPoint) {
    FillSampleGrid(*spec().frame, level, window.x, window.y, 1, window.width,
                   window.height, &buffers->grid);
  } else {
    FillSampleGrid(*spec().frame, level + 1, 2 * window.x + 1, 2 * window.y + 1,
                   2, window.width, window.height, &buffers->grid);
  }
  if (stop.stop_requested()) return false;
  if (what == What::kMacro) {
    macro_.Evaluate(buffers->grid, out, out_stride, stop);
    return !stop.stop_requested();
  }
  const GridView fractal = Fractal(level, sampling, window, stop, buffers);
  if (fractal.data == nullptr) return false;
  MapBlock(what, window, fractal, stop, buffers, out, out_stride);
  return !stop.stop_requested();
}

GridView Terrain::Impl::Fractal(int level, Sampling sampling,
                                const Window& window,
                                const std::stop_token& stop,
                                TileScratch::Buffers* buffers) const {
  if (spec().dimensions == 2) {
    return sampling == Sampling::kPoint
               ? lattice_->Points(level, window, stop, &buffers->lattice)
               : lattice_->Centres(level, window, stop, &buffers->lattice);
  }
  const bool point = sampling == Sampling::kPoint;
  const std::span<const float> line =
      point ? line_->Points(level, window.x, window.width, stop, &buffers->line)
            : line_->Points(level + 1, 2 * window.x + 1, 2 * window.width - 1,
                            stop, &buffers->line);
  if (line.empty()) return {};
  const GridView plane = buffers->fractal.Shape(window.width, 1);
  for (std::int64_t i = 0; i < window.width; ++i) {
    plane.data[i] = line[static_cast<std::size_t>(point ? i : 2 * i)];
  }
  return plane;
}

void Terrain::Impl::MapBlock(What what, const Window& window, GridView fractal,
                             const std::stop_token& stop,
                             TileScratch::Buffers* buffers, float* out,
                             std::ptrdiff_t out_stride) const {
  if (what == What::kFractal) {
    const auto sigma = static_cast<float>(*spec().sigma);
    for (std::int64_t j = 0; j < window.height; ++j) {
      for (std::int64_t i = 0; i < window.width; ++i) {
        out[j * out_stride + i] = sigma * fractal.At(i, j);
      }
    }
    return;
  }
  GridView macro;
  const std::optional<float> constant = macro_.constant();
  if (!constant) {
    macro = buffers->macro.Shape(window.width, window.height);
    macro_.Evaluate(buffers->grid, macro.data, macro.stride, stop);
  }
  GridView fidelity = buffers->fidelity.Shape(window.width, window.height);
  if (!fidelity_.Evaluate(buffers->grid, fidelity.data, fidelity.stride,
                          stop)) {
    fidelity = {};
  }
  for (std::int64_t j = 0; j < window.height; ++j) {
    MapRow(map_, fractal.Row(j), macro.data ? macro.Row(j) : nullptr,
           constant.value_or(0), fidelity.data ? fidelity.Row(j) : nullptr,
           static_cast<int>(window.width), out + j * out_stride);
  }
}

// --- Bounds -----------------------------------------------------------------

double Terrain::Impl::DeviationBoundOr(double unbounded) const {
  if (spec().mapping == HeightMapping::kBoltzmann) {
    const double delta = *spec().delta;
    return std::sqrt(-2 * static_cast<double>(fidelity_.maximum()) *
                     DetLog(delta / (kSqrt6 + delta)));
  }
  return spec().soft_limit ? *spec().soft_limit : unbounded;
}

HeightRange Terrain::Impl::LikelyRange() const {
  // The variance of P is at most the sum of the displacements' along a chain of
  // ancestors: the stencils average.
  double variance =
      Level0Deviation(spec().source) * Level0Deviation(spec().source);
  const ConstraintField roughness(spec().continuous_constraints,
                                  ConstraintQuantity::kRoughness,
                                  *spec().roughness, spec().dimensions);
  const auto h = static_cast<double>(roughness.minimum());
  for (int level = 1; level <= kMaxLevel; ++level) {
    for (const HalfStep step : {HalfStep::kCentre, HalfStep::kEdge}) {
      const double d = DisplacementDeviation(spec().source, spec().dimensions,
                                             h, level, step);
      variance += d * d;
    }
  }
  const double amplitude =
      resolved_.amplitude.empty()
          ? 1.0
          : static_cast<double>(*std::max_element(resolved_.amplitude.begin(),
                                                  resolved_.amplitude.end()));
  const double likely =
      kLikelyDeviations * amplitude *
      std::sqrt(static_cast<double>(fidelity_.maximum()) * variance);
  const double deviation = std::min(likely, DeviationBoundOr(likely));

  constexpr double kEverywhereInPlane = 1e300;
  MacroShape::Bounds bounds =
      macro_.BoundsIn(-kEverywhereInPlane, -kEverywhereInPlane,
                      kEverywhereInPlane, kEverywhereInPlane);
  if (spec().domain) {
    const Frame& frame = *spec().frame;
    const double x1 =
        frame.origin_x +
        static_cast<double>(spec().domain->cells_x) * frame.spacing_x;
    const double y1 =
        frame.origin_y +
        static_cast<double>(spec().domain->cells_y) * frame.spacing_y;
    bounds = macro_.BoundsIn(
        std::min(frame.origin_x, x1), std::min(frame.origin_y, y1),
        std::max(frame.origin_x, x1), std::max(frame.origin_y, y1));
  }
  return {static_cast<float>(bounds.minimum - deviation),
          static_cast<float>(bounds.maximum + deviation)};
}

// --- The public face --------------------------------------------------------

Terrain::Terrain(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
Terrain::~Terrain() = default;

absl::StatusOr<std::shared_ptr<const Terrain>> Terrain::Create(
    TerrainSpec spec, const Preparation&) {
  absl::StatusOr<std::unique_ptr<const Impl>> impl =
      Impl::Create(std::move(spec));
  if (!impl.ok()) return impl.status();
  return std::shared_ptr<const Terrain>(new Terrain(*std::move(impl)));
}

const TerrainSpec& Terrain::spec() const { return impl_->spec(); }

std::optional<Window> Terrain::Extent(int level, Sampling sampling) const {
  return impl_->Extent(level, sampling);
}

absl::Status Terrain::CheckRequest(const TileRequest& request) const {
  return impl_->CheckRequest(request);
}

absl::Status Terrain::Generate(const TileRequest& request, std::stop_token stop,
                               TileScratch* scratch,
                               std::span<float> out) const {
  return impl_->Generate(Impl::What::kHeight, request, stop,
                         &scratch->buffers(), out.data());
}

absl::Status Terrain::GenerateMacro(const TileRequest& request,
                                    TileScratch* scratch,
                                    std::span<float> out) const {
  return impl_->Generate(Impl::What::kMacro, request, {}, &scratch->buffers(),
                         out.data());
}

absl::Status Terrain::GenerateFractal(const TileRequest& request,
                                      std::stop_token stop,
                                      TileScratch* scratch,
                                      std::span<float> out) const {
  return impl_->Generate(Impl::What::kFractal, request, stop,
                         &scratch->buffers(), out.data());
}

absl::Status Terrain::GenerateAt(int level, std::span<const Point2> points,
                                 std::stop_token stop, TileScratch* scratch,
                                 std::span<float> out) const {
  return GenerateScattered(*this, level, points, stop, scratch,
                           &scratch->buffers().scattered, out);
}

std::int64_t Terrain::GeneratedPoints(const TileRequest& request) const {
  return impl_->GeneratedPoints(request);
}

std::optional<double> Terrain::DeviationBound() const {
  const double bound = impl_->DeviationBoundOr(-1);
  if (bound < 0) return std::nullopt;
  return bound;
}

std::optional<SpotReport> Terrain::spots() const { return std::nullopt; }
std::int64_t Terrain::MemoryBytes() const { return 0; }
PreparationCost Terrain::EstimatePreparation(const TerrainSpec&) { return {}; }

HeightRange Terrain::LikelyRange() const { return impl_->LikelyRange(); }

}  // namespace terrane::core
