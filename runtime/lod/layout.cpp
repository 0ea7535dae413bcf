#include "runtime/lod/layout.h"

namespace voyager {
namespace {

void allocate_merged(size_t count, BakedScene& baked) {
  GaussianCloud& merged = baked.merged;
  merged.sh_degree = baked.leaves.sh_degree;
  merged.native = baked.leaves.native;
  merged.origin = baked.origin;
  merged.position.resize(3 * count);
  merged.log_scale.resize(3 * count);
  merged.rotation.resize(4 * count);
  merged.opacity.resize(count);
  merged.sh.resize(count * size_t{3} * static_cast<size_t>(merged.coefficients()));
}

}  // namespace

std::vector<uint32_t> lay_out_scene(const TreeLayout& layout, BakedScene& baked) {
  LodTree& tree = baked.tree;
  tree.blend_share = blend_share(baked.kind);
  const size_t nodes = layout.child_count.size();
  tree.records.resize(nodes);
  tree.first_child.resize(nodes);
  tree.parent.resize(nodes, kNoNode);
  baked.gaussian.resize(nodes);
  baked.node_code.resize(nodes);
  const bool exposed = !layout.exposure.empty();
  if (baked.kind == TreeKind::clustered) baked.exposure.assign(nodes, {1, 0, 0});
  std::vector<uint32_t> levels;
  uint32_t next = 1, level_end = 0, leaf = 0, merged = 0;
  for (uint32_t n = 0; n < nodes; ++n) {
    if (n == level_end) {
      levels.push_back(n);
      level_end = next;
    }
    const uint32_t children = layout.child_count[n];
    tree.records[n].child_count = children;
    if (children == 0) {
      if (exposed) baked.exposure[n] = exposure_of(layout.exposure[leaf]);
      if (!layout.footprint.empty()) baked.node_code[n] = node_code(0, layout.footprint[leaf]);
      baked.gaussian[n] = layout.leaf[leaf++];
      continue;
    }
    baked.gaussian[n] = merged++;
    tree.first_child[n] = next;
    for (uint32_t i = 0; i < children; ++i) tree.parent[next++] = n;
  }
  if (nodes != 0) levels.push_back(static_cast<uint32_t>(nodes));
  allocate_merged(merged, baked);
  return levels;
}

}  // namespace voyager
