#include "core/codec/obj.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>

namespace terrane::core {
namespace {

template <typename Number>
void AppendNumber(Number number, std::string* text) {
  char digits[32];
  const std::to_chars_result end =
      std::to_chars(std::begin(digits), std::end(digits), number);
  text->append(std::begin(digits), end.ptr);
}

void AppendLine(const char* keyword, std::initializer_list<float> numbers,
                std::string* text) {
  *text += keyword;
  for (const float number : numbers) {
    *text += ' ';
    AppendNumber(number, text);
  }
  *text += '\n';
}

// A corner of a face: v, v/vt, v//vn or v/vt/vn, all of one number from 1.
void AppendCorner(std::uint32_t index, bool uvs, bool normals,
                  std::string* text) {
  const std::uint64_t number = std::uint64_t{index} + 1;
  *text += ' ';
  AppendNumber(number, text);
  if (!uvs && !normals) return;
  *text += '/';
  if (uvs) AppendNumber(number, text);
  if (!normals) return;
  *text += '/';
  AppendNumber(number, text);
}

}  // namespace

std::string EncodeObj(const Mesh& mesh, const std::string& name) {
  std::string text = "o " + name + "\n";
  for (const Float3& p : mesh.positions) {
    AppendLine("v", {p.x, p.y, p.z}, &text);
  }
  for (const Float2& uv : mesh.uvs) AppendLine("vt", {uv.x, uv.y}, &text);
  for (const Float3& n : mesh.normals) {
    AppendLine("vn", {n.x, n.y, n.z}, &text);
  }
  for (std::size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
    text += 'f';
    for (std::size_t corner = k; corner < k + 3; ++corner) {
      AppendCorner(mesh.indices[corner], !mesh.uvs.empty(),
                   !mesh.normals.empty(), &text);
    }
    text += '\n';
  }
  return text;
}

}  // namespace terrane::core
