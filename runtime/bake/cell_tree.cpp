#include "runtime/bake/cell_tree.h"

#include <algorithm>

#include "runtime/bake/sealed_file.h"
#include "runtime/lod/kd_layout.h"
#include "runtime/lod/levels.h"

namespace voyager {
namespace {

struct CellFile {
  std::vector<NodeRow> nodes;
  TreeLayout layout;
};

CellFile read_file(const BakePlan& plan, uint32_t cell, const WorkFolder& folder) {
  const std::string path = folder.file(cell_tree_name(cell));
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  CellFile file;
  from.take_all(file.nodes);
  from.take_all(file.layout.child_count);
  from.take_all(file.layout.leaf);
  if (file.layout.leaf.size() != plan.cell_size(cell))
    refuse_folder(path, std::to_string(file.layout.leaf.size()) + " Gaussians",
                  std::to_string(plan.cell_size(cell)));
  return file;
}

CellTree merge_cell(CellRows rows, const TreeLayout& layout, const std::array<double, 3>& origin,
                    Workers& workers) {
  CellTree tree;
  tree.baked.leaves = std::move(rows.cloud);
  tree.baked.origin = origin;
  tree.sources = std::move(rows.sources);
  tree.levels = lay_out_scene(layout, tree.baked);
  summarise_levels(tree.levels, tree.baked, workers);
  return tree;
}

NodeRow row_of(const BakedScene& baked, uint32_t node) {
  NodeRow row{};
  row.record = baked.tree.records[node];
  const size_t i = baked.gaussian[node];
  row.words = baked.merged.words(i);
  const size_t floats = static_cast<size_t>(baked.merged.coefficients()) * 3;
  std::copy_n(baked.merged.sh.data() + i * floats, floats, row.sh);
  return row;
}

}  // namespace

std::string cell_tree_name(uint32_t cell) {
  return "cell-" + std::to_string(cell) + ".tree";
}

void build_cell(const SplitInfo& split, const BakePlan& plan, uint32_t cell,
                const WorkFolder& folder, Workers& workers) {
  CellRows rows = read_cell_rows(split, plan, cell, folder);
  const TreeLayout layout = kd_layout(rows.cloud, split.origin, workers);
  const CellTree tree = merge_cell(std::move(rows), layout, split.origin, workers);
  std::vector<NodeRow> nodes;
  const uint32_t end = tree.levels[plan.top_levels() - plan.cell_level()];
  for (uint32_t node = 0; node < end; ++node) nodes.push_back(row_of(tree.baked, node));
  Packer packer;
  packer.put_all(nodes).put_all(layout.child_count).put_all(layout.leaf);
  write_sealed(folder.file(cell_tree_name(cell)), packer.bytes());
}

CellTree rebuild_cell(const SplitInfo& split, const BakePlan& plan, uint32_t cell,
                      const WorkFolder& folder, Workers& workers) {
  const CellFile file = read_file(plan, cell, folder);
  return merge_cell(read_cell_rows(split, plan, cell, folder), file.layout, split.origin, workers);
}

std::vector<NodeRow> read_cell_nodes(const BakePlan& plan, uint32_t cell,
                                     const WorkFolder& folder) {
  return read_file(plan, cell, folder).nodes;
}

}  // namespace voyager
