#pragma once
// Trees of cells that no count of Gaussians gives: cells of one size that differ in shape
// and in depth. Also the whole tree over such cells.
#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "runtime/bake/cell_shape.h"
#include "runtime/lod/build.h"
#include "runtime/lod/layout.h"
#include "runtime/lod/shape.h"

namespace voyager::test {

// So many leaves below each child of a node, at least one. `skew` 1: any; more: the last
// child tends to have most of them.
inline std::vector<uint32_t> random_parts(uint32_t leaves, uint32_t skew, std::mt19937& random) {
  const uint32_t parts =
      std::min<uint32_t>(leaves, random() % 16 == 0 ? 1 : 2 + random() % (kChildren - 1));
  std::vector<uint32_t> sizes;
  for (uint32_t left = parts; left > 1; --left) {
    sizes.push_back(1 + random() % std::max(1u, (leaves - left + 1) / skew));
    leaves -= sizes.back();
  }
  sizes.push_back(leaves);
  return sizes;
}

// Over at least 4 leaves, of which none is on the first kSharedLevels levels.
inline TreeLayout random_cell(uint32_t leaves, uint32_t seed) {
  std::mt19937 random(seed);
  const uint32_t skew = 1 + seed % 4;
  TreeLayout layout;
  std::vector<uint32_t> level{leaves};
  for (uint32_t depth = 0; !level.empty(); ++depth) {
    std::vector<uint32_t> below;
    for (const uint32_t size : level) {
      std::vector<uint32_t> sizes;
      if (depth < kSharedLevels)
        sizes = {size / 2, size - size / 2};
      else if (size > 1)
        sizes = random_parts(size, skew, random);
      layout.child_count.push_back(static_cast<uint8_t>(sizes.size()));
      below.insert(below.end(), sizes.begin(), sizes.end());
    }
    level = std::move(below);
  }
  layout.leaf.resize(leaves);
  std::iota(layout.leaf.begin(), layout.leaf.end(), 0u);
  std::shuffle(layout.leaf.begin(), layout.leaf.end(), random);
  return layout;
}

// The tree that has these cells on a level, and kChildren children a node above.
inline TreeLayout joined(const std::vector<TreeLayout>& cells) {
  TreeLayout whole;
  for (size_t nodes = 1; nodes < cells.size(); nodes *= kChildren)
    whole.child_count.insert(whole.child_count.end(), nodes, uint8_t{kChildren});
  std::vector<uint32_t> node(cells.size()), leaf(cells.size()), width(cells.size(), 1);
  for (bool any = true; any;) {
    any = false;
    for (size_t cell = 0; cell < cells.size(); ++cell) {
      uint32_t below = 0;
      for (uint32_t i = 0; i < width[cell]; ++i) {
        const uint8_t children = cells[cell].child_count[node[cell]++];
        whole.child_count.push_back(children);
        below += children;
        if (children == 0) whole.leaf.push_back(cells[cell].leaf[leaf[cell]++]);
      }
      width[cell] = below;
      any = any || below != 0;
    }
  }
  return whole;
}

}  // namespace voyager::test
