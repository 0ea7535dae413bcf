#include "runtime/bake/cell_sizes.h"

#include <algorithm>

#include "runtime/lod/shape.h"

namespace voyager {
namespace {

// Of the level below.
std::vector<uint32_t> children_of(const std::vector<uint32_t>& sizes, const KdRule& rule) {
  std::vector<uint32_t> below;
  for (const uint32_t size : sizes) {
    if (size <= rule.block) continue;
    const Parts parts = split_in_parts(size, rule);
    below.insert(below.end(), parts.size, parts.size + parts.count);
  }
  return below;
}

}  // namespace

uint32_t deepest_cell_level(uint32_t gaussians, const TreeRule& rule) {
  uint32_t level = 0;
  for (std::vector<uint32_t> sizes{gaussians}; level < 8; ++level) {
    sizes = children_of(sizes, kd_rule(rule));
    if (sizes.empty() || *std::min_element(sizes.begin(), sizes.end()) < least_cell(rule)) break;
  }
  return level;
}

std::vector<uint32_t> cell_sizes(uint32_t gaussians, uint32_t level, const TreeRule& rule) {
  std::vector<uint32_t> sizes{gaussians};
  for (uint32_t i = 0; i < level; ++i) sizes = children_of(sizes, kd_rule(rule));
  return sizes;
}

}  // namespace voyager
