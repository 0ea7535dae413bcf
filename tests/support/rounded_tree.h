#pragma once
#include "runtime/lod/round_bounds.h"

namespace voyager::test {

// As loading leaves a tree.
inline LodTree rounded(LodTree tree) {
  Workers workers(1);
  round_bounds(tree, workers);
  return tree;
}

}  // namespace voyager::test
