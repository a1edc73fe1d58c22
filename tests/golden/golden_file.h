// Goldens as text: one line a case, compared as it stands, or written anew with
// --bless. Lines begin with the case's name and " | "; those that begin with #
// are the file's header.
#ifndef TERRANE_TESTS_GOLDEN_GOLDEN_FILE_H_
#define TERRANE_TESTS_GOLDEN_GOLDEN_FILE_H_

#include <string>
#include <utility>
#include <vector>

namespace terrane::core {

// "hash | minimum | maximum | mean" of the values that are data (not NaN). The
// hash is FNV-1a, 64 bits, of all of them as little-endian float32.
std::string ValueColumns(const std::vector<float>& values);

// A case's name and its whole line.
using GoldenLines = std::vector<std::pair<std::string, std::string>>;

// Fails the running test where a line of `file` differs from the case's.
void ExpectGoldenLines(const GoldenLines& lines);

// The main of a golden test: runs the tests, or, with --bless, writes `header`
// and the lines to the golden file (TERRANE_GOLDEN_FILE).
int GoldenMain(int argc, char** argv, const char* header,
               GoldenLines (*make_lines)());

// Calls `expect` once for every SIMD target that this machine runs.
void OnEverySimdTarget(void (*expect)());

}  // namespace terrane::core

#endif  // TERRANE_TESTS_GOLDEN_GOLDEN_FILE_H_
