#include "core/codec/svg.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/codec/number_text.h"

namespace terrane::core {
namespace {

constexpr float kThinnest = 0.001f;  // of the picture's larger side

// The picture's edges; y runs down, as in SVG.
struct Frame2 {
  float left = std::numeric_limits<float>::infinity();
  float top = left;
  float right = -left;
  float bottom = -left;

  void Hold(const Float3& p, float radius) {
    left = std::min(left, p.x - radius);
    right = std::max(right, p.x + radius);
    top = std::min(top, -p.z - radius);
    bottom = std::max(bottom, -p.z + radius);
  }
  float LargerSide() const { return std::max(right - left, bottom - top); }
};

Frame2 FrameOf(const SegmentBlock& tree) {
  Frame2 frame;
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    frame.Hold(tree.start[row], tree.radius_start[row]);
    frame.Hold(tree.end[row], tree.radius_end[row]);
  }
  // A line without a width has a frame all the same.
  const float margin = kThinnest * frame.LargerSide();
  return {frame.left - margin, frame.top - margin, frame.right + margin,
          frame.bottom + margin};
}

void AppendAttribute(const char* name, float value, std::string* text) {
  *text += name;
  *text += "=\"";
  AppendNumber(value, text);
  *text += "\" ";
}

void AppendLine(const SegmentBlock& tree, std::size_t row, float thinnest,
                std::string* text) {
  const float width = tree.radius_start[row] + tree.radius_end[row];
  *text += "<line ";
  AppendAttribute("x1", tree.start[row].x, text);
  AppendAttribute("y1", -tree.start[row].z, text);
  AppendAttribute("x2", tree.end[row].x, text);
  AppendAttribute("y2", -tree.end[row].z, text);
  AppendAttribute("stroke-width", std::max(width, thinnest), text);
  *text += "/>\n";
}

}  // namespace

std::string EncodeTreeSvg(const SegmentBlock& tree, const std::string& colour) {
  if (tree.rows() == 0) return "<svg xmlns=\"http://www.w3.org/2000/svg\"/>\n";
  const Frame2 frame = FrameOf(tree);
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"";
  AppendNumber(frame.left, &text);
  AppendNumber(' ', frame.top, &text);
  AppendNumber(' ', frame.right - frame.left, &text);
  AppendNumber(' ', frame.bottom - frame.top, &text);
  text += "\">\n<g stroke=\"" + colour + "\" stroke-linecap=\"round\">\n";
  GenerationWalk generations(tree);
  int group = -1;
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    if (generations.At(row) != group) {
      if (group >= 0) text += "</g>\n";
      group = generations.At(row);
      text += "<g id=\"generation-" + std::to_string(group) + "\">\n";
    }
    AppendLine(tree, row, kThinnest * frame.LargerSide(), &text);
  }
  return text + "</g>\n</g>\n</svg>\n";
}

}  // namespace terrane::core
