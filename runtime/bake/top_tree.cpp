#include "runtime/bake/top_tree.h"

#include <algorithm>

#include "runtime/lod/levels.h"
#include "runtime/lod/shape.h"
#include "runtime/lod/summarise.h"

namespace voyager {
namespace {

void make_room(uint32_t nodes, BakedScene& top) {
  top.tree.records.resize(nodes);
  top.tree.first_child.resize(nodes);
  top.tree.parent.resize(nodes, kNoNode);
  GaussianCloud& merged = top.merged;
  merged.sh_degree = top.leaves.sh_degree;
  merged.origin = top.origin;
  merged.position.resize(3 * size_t{nodes});
  merged.log_scale.resize(3 * size_t{nodes});
  merged.rotation.resize(4 * size_t{nodes});
  merged.opacity.resize(nodes);
  merged.sh.resize(nodes * static_cast<size_t>(merged.coefficients()) * 3);
  for (uint32_t i = 0; i < nodes; ++i) top.gaussian.push_back(i);
  top.node_code.resize(nodes);
  top.exposure.resize(nodes);
}

void put_node(const NodeRow& row, uint32_t node, BakedScene& top) {
  top.tree.records[node] = row.record;
  top.exposure[node] = row.exposure;
  top.node_code[node] = static_cast<uint8_t>(row.code);
  GaussianCloud& merged = top.merged;
  std::copy_n(&row.words.mean.x, 3, &merged.position[3 * size_t{node}]);
  std::copy_n(&row.words.log_scale.x, 3, &merged.log_scale[3 * size_t{node}]);
  std::copy_n(&row.words.rotation.w, 4, &merged.rotation[4 * size_t{node}]);
  merged.opacity[node] = row.words.opacity;
  const size_t floats = static_cast<size_t>(merged.coefficients()) * 3;
  std::copy_n(row.sh, floats, merged.sh.data() + node * floats);
}

// Of every cell, the levels that are the top's, too.
void put_cells(const BakePlan& plan, const WorkFolder& folder, BakedScene& top, Workers& workers) {
  workers.for_blocks(plan.cells(), 1, [&](size_t index, size_t) {
    const auto cell = static_cast<uint32_t>(index);
    const std::vector<NodeRow> rows = read_cell_nodes(cell, folder);
    size_t row = 0;
    for (uint32_t level = 0; plan.cell_level() + level < plan.top_levels(); ++level) {
      // The cells' nodes of a level lie one cell after the other.
      const uint32_t begin = plan.first_node(cell, level), end = plan.first_node(cell + 1, level);
      for (uint32_t node = begin; node < end; ++node) put_node(rows.at(row++), node, top);
    }
  });
}

// The cells' nodes have their child counts. Children may be below the top.
void link(const BakePlan& plan, LodTree& tree) {
  const auto nodes = static_cast<uint32_t>(tree.size());
  for (uint32_t node = 0, next = 1; node < nodes; ++node) {
    if (node < plan.first_node(0, 0)) tree.records[node].child_count = kChildren;
    tree.first_child[node] = next;
    for (const uint32_t end = next + tree.records[node].child_count; next < end; ++next)
      if (next < nodes) tree.parent[next] = node;
  }
}

}  // namespace

BakedScene build_top(const SplitInfo& split, const BakePlan& plan, const WorkFolder& folder,
                     Workers& workers) {
  BakedScene top;
  top.leaves.sh_degree = split.spool.sh_degree;
  top.leaves.native = split.spool.native;
  top.leaves.origin = split.spool.source_origin;
  top.origin = split.origin;
  const auto all = plan.tiers().level_begin;
  make_room(all[plan.top_levels()], top);
  put_cells(plan, folder, top, workers);
  link(plan, top.tree);
  for (uint32_t node = plan.first_node(0, 0); node-- > 0;) summarise(node, top);
  // Levels whose nodes have their children here, and the end of them.
  const std::vector<uint32_t> levels(all.begin(), all.begin() + plan.top_levels());
  align_levels(levels, top, workers);
  return top;
}

const NodeRecord& record_above(const BakedScene& top, const BakePlan& plan, uint32_t cell) {
  return top.tree.records[top.tree.parent[plan.first_node(cell, 0)]];
}

void align_cell(const BakedScene& top, const BakePlan& plan, uint32_t cell, CellTree& tree,
                Workers& workers) {
  const size_t root = tree.baked.gaussian[0], turned = plan.first_node(cell, 0);
  GaussianCloud& merged = tree.baked.merged;
  std::copy_n(&top.merged.log_scale[3 * turned], 3, &merged.log_scale[3 * root]);
  std::copy_n(&top.merged.rotation[4 * turned], 4, &merged.rotation[4 * root]);
  align_levels(tree.levels, tree.baked, workers);
}

}  // namespace voyager
