// The named recipes whose rows, leaves and meshes are kept in tree.txt.
#ifndef TERRANE_TESTS_GOLDEN_TREE_CASES_H_
#define TERRANE_TESTS_GOLDEN_TREE_CASES_H_

#include <string>
#include <vector>

#include "core/tree/tree_spec.h"

namespace terrane::core {

struct GoldenTree {
  std::string name;
  TreeSpec spec;

  // The parameters, for people.
  std::string Parameters() const;
};

// Every form, mode, dimension and control, at least once. In a fixed order.
std::vector<GoldenTree> GoldenTrees();

}  // namespace terrane::core

#endif  // TERRANE_TESTS_GOLDEN_TREE_CASES_H_
