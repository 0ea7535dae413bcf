#include "runtime/bake/cell_shape.h"

#include <string>

#include "runtime/base/error.h"
#include "runtime/lod/shape.h"

namespace voyager {
namespace {

// Then no root has its descendants in several subtrees: a tier has a subtree a root.
static_assert(1 + kChildren + kChildren * kChildren <= kSubtreeNodes);

[[noreturn]] void refuse(size_t node, const std::string& found, const std::string& expected) {
  throw Error(ErrorCode::internal, "node " + std::to_string(node) + " of a cell: found " + found +
                                       ", expected " + expected);
}

}  // namespace

std::vector<uint32_t> cell_levels(std::span<const uint8_t> child_count) {
  std::vector<uint32_t> levels;
  size_t next = 1, level_end = 0;
  for (size_t n = 0; n < child_count.size(); ++n) {
    if (n == level_end) {
      levels.push_back(static_cast<uint32_t>(n));
      level_end = next;
    }
    if (child_count[n] > kChildren)
      refuse(n, std::to_string(child_count[n]) + " children",
             "at most " + std::to_string(kChildren));
    if (child_count[n] == 0 && levels.size() <= kSharedLevels)
      refuse(n, "a leaf on level " + std::to_string(levels.size() - 1), "one further below");
    next += child_count[n];
  }
  if (next != child_count.size())
    refuse(child_count.size(), std::to_string(next) + " nodes by the counts of their children",
           "as many as have one");
  levels.push_back(static_cast<uint32_t>(next));
  return levels;
}

std::vector<uint8_t> subtree_nodes(std::span<const uint8_t> child_count,
                                   std::span<const uint32_t> levels, uint32_t level) {
  std::vector<uint8_t> nodes;
  if (level + 1 >= levels.size()) return nodes;
  nodes.reserve(levels[level + 1] - levels[level]);
  uint32_t child = levels[level + 1];
  for (uint32_t n = levels[level]; n < levels[level + 1]; ++n) {
    uint32_t count = 1u + child_count[n];
    for (const uint32_t end = child + child_count[n]; child < end; ++child)
      count += child_count[child];
    nodes.push_back(static_cast<uint8_t>(count));
  }
  return nodes;
}

}  // namespace voyager
