#include "core/terrain/terrain.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/terrain/conditioning.h"
#include "core/terrain/fractal_lattice.h"
#include "core/terrain/fractal_line.h"
#include "core/terrain/macro_shape.h"
#include "core/terrain/mapping_kernels.h"
#include "core/terrain/resolve.h"
#include "core/terrain/scattered.h"
#include "core/terrain/spot_heights.h"
#include "core/terrain/terrain_bounds.h"
#include "core/terrain/validate.h"

namespace terrane::core {
namespace {

// Largest side of a block that is generated at once: its working memory (about
// 1.5 MB) stays in the second-level cache.
constexpr std::int64_t kBlockSize = 288;

constexpr double kSqrt6 = 2.449489742783178;

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
  std::vector<SpotPins::Found> pins;
};

TileScratch::TileScratch() : buffers_(std::make_unique<Buffers>()) {}
TileScratch::~TileScratch() = default;
TileScratch::TileScratch(TileScratch&&) noexcept = default;
TileScratch& TileScratch::operator=(TileScratch&&) noexcept = default;

class Terrain::Impl {
 public:
  static absl::StatusOr<std::unique_ptr<const Impl>> Create(
      TerrainSpec spec, const Preparation& preparation);

  const TerrainSpec& spec() const { return resolved_.spec; }
  std::optional<Window> Extent(int level, Sampling sampling) const;
  absl::Status CheckRequest(const TileRequest& request) const;

  enum class What { kHeight, kMacro, kFractal };
  absl::Status Generate(What what, const TileRequest& request,
                        const std::stop_token& stop,
                        TileScratch::Buffers* buffers, float* out) const;
  std::int64_t GeneratedPoints(const TileRequest& request) const;
  std::optional<double> DeviationBound() const {
    return LargestDeviationOf(spec(), fidelity_);
  }
  HeightRange LikelyRange() const {
    return LikelyHeights(resolved_, macro_, fidelity_, largest_spot_deviation_);
  }
  std::optional<SpotReport> spots() const { return spots_; }
  std::int64_t MemoryBytes() const;

 private:
  explicit Impl(ResolvedSpec resolved);
  absl::Status Impose(const Preparation& preparation);
  absl::StatusOr<Imposed> Condition(const DeviationModel& model,
                                    const Preparation& preparation);

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
  void PinSpots(int level, Sampling sampling, const Window& window,
                TileScratch::Buffers* buffers, float* out,
                std::ptrdiff_t out_stride) const;

  ResolvedSpec resolved_;
  MacroShape macro_;
  ConstraintField fidelity_;
  HeightMap map_;
  Imposed imposed_;
  std::optional<SpotReport> spots_;
  double largest_spot_deviation_ = 0;  // of the spots from the macro shape
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

Terrain::Impl::Impl(ResolvedSpec resolved)
    : resolved_(std::move(resolved)),
      macro_(spec().macro, spec().dimensions, *spec().frame),
      fidelity_(spec().continuous_constraints, ConstraintQuantity::kFidelity,
                *spec().fidelity, spec().dimensions) {
  map_.mapping = spec().mapping;
  map_.inverse_soft_limit =
      spec().soft_limit ? static_cast<float>(1 / *spec().soft_limit) : 0.0f;
  map_.z = static_cast<float>(1 / (kSqrt6 + *spec().delta));
  // The square root of the float, as a sample under a constraint takes it.
  map_.deviation = std::sqrt(fidelity_.background());
}

// Conditions the process on the spots and keeps them.
absl::StatusOr<Imposed> Terrain::Impl::Condition(
    const DeviationModel& model, const Preparation& preparation) {
  absl::StatusOr<SnappedSpots> snapped =
      SnapSpots(spec(), macro_, fidelity_, map_);
  if (!snapped.ok()) return snapped.status();
  const ConditionedProcess process = {spec().seed,
                                      spec().source,
                                      spec().dimensions,
                                      {spec().domain},
                                      spec().refinement.has_value(),
                                      *spec().roughness,
                                      &model};
  absl::StatusOr<CorrectionTable> table =
      ConditionProcess(process, snapped->spots, preparation);
  if (!table.ok()) return table.status();
  spots_ = snapped->report;
  largest_spot_deviation_ = snapped->largest_deviation;
  Imposed imposed;
  imposed.corrections =
      std::make_shared<const CorrectionTable>(*std::move(table));
  imposed.pins = std::make_shared<const SpotPins>(snapped->spots);
  return imposed;
}

// Makes the process pass through what the spec asks for.
absl::Status Terrain::Impl::Impose(const Preparation& preparation) {
  DeviationModel model(ModelConfig(resolved_));
  if (!spec().spots.empty() || ConditionsDiscrete(spec())) {
    absl::StatusOr<Imposed> conditioned = Condition(model, preparation);
    if (!conditioned.ok()) return conditioned.status();
    imposed_ = *std::move(conditioned);
  } else if (!spec().discrete_constraints.empty()) {
    absl::StatusOr<DiscreteConstraints> constraints =
        DiscreteConstraints::Create(spec(), *spec().frame);
    if (!constraints.ok()) return constraints.status();
    imposed_.constraints =
        std::make_shared<const DiscreteConstraints>(*std::move(constraints));
  }
  const Mirror mirror = {spec().domain};
  if (spec().dimensions == 2) {
    lattice_.emplace(FractalLattice::Config{spec().seed, spec().source, mirror,
                                            spec().refinement.has_value()},
                     std::move(model), imposed_);
  } else {
    line_.emplace(FractalLine::Config{spec().seed, spec().source, mirror},
                  std::move(model), imposed_);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<const Terrain::Impl>> Terrain::Impl::Create(
    TerrainSpec spec, const Preparation& preparation) {
  Violations violations;
  ValidateSpec(spec, SpecLimits(), "", &violations);
  if (!violations.empty()) return violations.ToStatus();
  absl::StatusOr<ResolvedSpec> resolved = Resolve(std::move(spec));
  if (!resolved.ok()) return resolved.status();
  std::unique_ptr<Impl> impl(new Impl(*std::move(resolved)));
  const absl::Status status = impl->Impose(preparation);
  if (!status.ok()) return status;
  return impl;
}

std::int64_t Terrain::Impl::MemoryBytes() const {
  std::int64_t bytes =
      static_cast<std::int64_t>(resolved_.amplitude.size() * sizeof(float));
  if (imposed_.corrections) bytes += imposed_.corrections->MemoryBytes();
  if (imposed_.pins) bytes += imposed_.pins->MemoryBytes();
  return bytes;
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
  if (what == What::kHeight) {
    PinSpots(level, sampling, window, buffers, out, out_stride);
  }
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

// A spot's height to the last bit, whatever float arithmetic left of it.
void Terrain::Impl::PinSpots(int level, Sampling sampling, const Window& window,
                             TileScratch::Buffers* buffers, float* out,
                             std::ptrdiff_t out_stride) const {
  if (imposed_.pins == nullptr) return;
  if (sampling == Sampling::kPoint) {
    imposed_.pins->Find(level, window.x, window.y, 1, window.width,
                        window.height, &buffers->pins);
  } else if (spec().source != FractalSource::kSuccessive) {
    // Centres are points of the next level; SUCCESSIVE moves them there.
    const std::int64_t y = spec().dimensions == 1 ? 0 : 2 * window.y + 1;
    imposed_.pins->Find(level + 1, 2 * window.x + 1, y, 2, window.width,
                        window.height, &buffers->pins);
  } else {
    return;
  }
  for (const SpotPins::Found& pin : buffers->pins) {
    out[pin.j * out_stride + pin.i] = pin.height;
  }
}

// --- The public face --------------------------------------------------------

Terrain::Terrain(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
Terrain::~Terrain() = default;

absl::StatusOr<std::shared_ptr<const Terrain>> Terrain::Create(
    TerrainSpec spec, const Preparation& preparation) {
  absl::StatusOr<std::unique_ptr<const Impl>> impl =
      Impl::Create(std::move(spec), preparation);
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
  return impl_->DeviationBound();
}

std::optional<SpotReport> Terrain::spots() const { return impl_->spots(); }

std::int64_t Terrain::MemoryBytes() const { return impl_->MemoryBytes(); }

PreparationCost Terrain::EstimatePreparation(const TerrainSpec& spec) {
  const Frame frame = FrameOf(spec);
  const int level = spec.spots.level.value_or(
      DefaultSpotLevel(spec.spots, frame, spec.dimensions));
  std::size_t spots = spec.spots.points.size();
  if (spec.spots.table != nullptr) spots += spec.spots.table->size();
  spots += CountLineSamples(spec.spots, frame, level, spec.dimensions,
                            static_cast<std::size_t>(SpecLimits().max_spots));
  if (ConditionsDiscrete(spec)) spots += spec.discrete_constraints.size();
  return ConditioningCost(spec.source, spec.dimensions,
                          static_cast<std::int64_t>(spots), level);
}

HeightRange Terrain::LikelyRange() const { return impl_->LikelyRange(); }

}  // namespace terrane::core
