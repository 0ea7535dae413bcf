#include "runtime/lod/shape.h"

namespace voyager {
namespace {

void split(uint32_t size, uint32_t unit, int times, Parts& parts) {
  if (times == 0 || size <= unit) {
    parts.size[parts.count++] = size;
    return;
  }
  const uint32_t lower = lower_part(size, unit);
  split(lower, unit, times - 1, parts);
  split(size - lower, unit, times - 1, parts);
}

}  // namespace

Parts split_in_parts(uint32_t size) {
  Parts parts{};
  split(size, split_unit(size), 2, parts);
  return parts;
}

uint64_t count_nodes(uint32_t gaussians) {
  if (gaussians <= 1) return gaussians;
  const Parts parts = split_in_parts(gaussians);
  uint64_t nodes = 1;
  for (uint32_t i = 0; i < parts.count; ++i) nodes += count_nodes(parts.size[i]);
  return nodes;
}

std::vector<uint32_t> lay_out(const std::vector<uint32_t>& order, BakedScene& baked) {
  LodTree& tree = baked.tree;
  const uint32_t gaussians = static_cast<uint32_t>(order.size());
  const size_t nodes = count_nodes(gaussians);
  tree.records.resize(nodes);
  tree.first_child.resize(nodes);
  tree.parent.resize(nodes, kNoNode);
  baked.gaussian.resize(nodes);
  std::vector<uint32_t> levels;
  if (nodes == 0) return levels;

  // Until its turn comes, a node keeps its range of `order` in its own fields:
  // the start in `gaussian`, the size in `child_count`.
  tree.records[0].child_count = gaussians;
  uint32_t next = 1, level_end = 0, merged = 0;
  for (uint32_t n = 0; n < nodes; ++n) {
    if (n == level_end) {
      levels.push_back(n);
      level_end = next;
    }
    const uint32_t size = tree.records[n].child_count;
    uint32_t begin = baked.gaussian[n];
    if (size == 1) {
      tree.records[n].child_count = 0;
      baked.gaussian[n] = order[begin];
      continue;
    }
    const Parts parts = split_in_parts(size);
    tree.records[n].child_count = parts.count;
    tree.first_child[n] = next;
    baked.gaussian[n] = merged++;
    for (uint32_t i = 0; i < parts.count; ++i, ++next) {
      tree.parent[next] = n;
      tree.records[next].child_count = parts.size[i];
      baked.gaussian[next] = begin;
      begin += parts.size[i];
    }
  }
  levels.push_back(static_cast<uint32_t>(nodes));
  return levels;
}

}  // namespace voyager
