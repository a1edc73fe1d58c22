// P_fbm over a line: the 1-D counterpart of FractalLattice.
//
// A level has one step: the midpoints (M = 2), or four-point subdivision.
// Values are for sigma = 1. Immutable and thread-safe. Determinism: a value is
// a function of (config, level, index). Plain loops: a profile is small.
//
// Source: Tan & Chen 2003, eqs. 5, 11, 12.
#ifndef TERRANE_CORE_TERRAIN_FRACTAL_LINE_H_
#define TERRANE_CORE_TERRAIN_FRACTAL_LINE_H_

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "core/terrain/deviation_model.h"
#include "core/terrain/imposed.h"
#include "core/terrain/mirror.h"

namespace terrane::core {

class FractalLine {
 public:
  struct Config {
    std::int64_t seed = 0;
    FractalSource source = FractalSource::kSubdivision;
    Mirror mirror;
  };

  struct Scratch {
    std::vector<float> lines[2];
    GridBuffer deviation;
    DeviationModel::Scratch model;
    std::vector<LatticePoint> found;
    std::vector<LatticePoint> buffered;
    std::vector<float> buffered_values;
    std::vector<SpotPins::Found> pins;
  };

  FractalLine(Config config, DeviationModel model, Imposed imposed);

  // POINT samples [first, first + count) of `level`; empty when stopped. Lives
  // in the scratch until its next use.
  std::span<const float> Points(int level, std::int64_t first,
                                std::int64_t count, const std::stop_token& stop,
                                Scratch* scratch) const;

  // Points that computing them takes, ancestors included.
  std::int64_t PointsComputed(int level, std::int64_t count) const;

 private:
  struct Line {
    std::int64_t first = 0;
    std::int64_t count = 0;
  };

  Line ParentOf(const Line& child) const;
  std::vector<Line> Ancestors(int level, const Line& line) const;
  void FillLevel0(const Line& line, std::vector<float>* values) const;
  void Refine(int level, const Line& parent, const std::vector<float>& from,
              std::vector<float>* to, Scratch* scratch) const;
  void Correct(int level, HalfStep step, const Line& line,
               std::vector<float>* values) const;
  std::vector<bool> HeldPoints(int level, const Line& line,
                               Scratch* scratch) const;
  void AddBuffers(const Line& line, std::vector<float>* values,
                  Scratch* scratch) const;
  void MeetConstraints(int level, const Line& line, std::vector<float>* values,
                       Scratch* scratch) const;
  float Normal(int level, std::int64_t index) const;

  Config config_;
  DeviationModel model_;
  Imposed imposed_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_FRACTAL_LINE_H_
