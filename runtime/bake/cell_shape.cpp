#include "runtime/bake/cell_shape.h"

#include <string>

#include "runtime/base/error.h"
#include "runtime/lod/shape.h"

namespace voyager {
namespace {

// Then no root has its descendants in several subtrees.
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

std::vector<RootShape> root_shapes(std::span<const uint8_t> child_count,
                                   std::span<const uint32_t> levels, uint32_t level) {
  std::vector<RootShape> roots;
  if (level + 1 >= levels.size()) return roots;
  roots.reserve(levels[level + 1] - levels[level]);
  uint32_t above = level == 0 ? 0 : levels[level - 1];  // whose children come next
  uint32_t siblings = 0;                                // of them that are still to come
  uint32_t child = levels[level + 1];
  for (uint32_t n = levels[level]; n < levels[level + 1]; ++n) {
    const bool first = siblings == 0;
    if (first && level == 0) {
      siblings = 1;
    } else if (first) {
      while (child_count[above] == 0) ++above;
      siblings = child_count[above++];
    }
    --siblings;
    uint32_t grandchildren = 0;
    for (const uint32_t end = child + child_count[n]; child < end; ++child)
      grandchildren += child_count[child];
    RootShape shape{};
    shape.nodes = static_cast<uint8_t>(1u + child_count[n] + grandchildren) & 31u;
    shape.sibling = !first;
    shape.deep = grandchildren != 0;
    roots.push_back(shape);
  }
  return roots;
}

}  // namespace voyager
