#include "runtime/bake/cell_tree.h"

#include <algorithm>

#include "runtime/bake/cell_shape.h"
#include "runtime/bake/sealed_file.h"
#include "runtime/lod/find_layout.h"
#include "runtime/lod/levels.h"

namespace voyager {
namespace {

struct TreeFile {
  std::vector<NodeRow> nodes;
  std::vector<uint8_t> child_count;
};

TreeFile read_tree(uint32_t cell, const WorkFolder& folder) {
  const std::string path = folder.file(cell_tree_name(cell));
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  TreeFile file;
  from.take_all(file.nodes);
  from.take_all(file.child_count);
  return file;
}

// Into the leaves of a layout.
void read_leaves(uint32_t gaussians, uint32_t cell, const WorkFolder& folder, TreeLayout& layout) {
  const std::string path = folder.file(cell_leaves_name(cell));
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  from.take_all(layout.leaf);
  from.take_all(layout.exposure);
  from.take_all(layout.footprint);
  if (layout.footprint.empty()) layout.footprint.resize(gaussians);
  for (const size_t found : {layout.leaf.size(), layout.exposure.size(), layout.footprint.size()})
    if (found != gaussians)
      refuse_folder(path, std::to_string(found) + " Gaussians", std::to_string(gaussians));
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
  row.exposure = baked.exposure[node];
  row.code = baked.node_code[node];
  const size_t floats = static_cast<size_t>(baked.merged.coefficients()) * 3;
  std::copy_n(baked.merged.sh.data() + i * floats, floats, row.sh);
  return row;
}

}  // namespace

void build_cell(const SplitInfo& split, uint32_t cell, const TreeRule& rule,
                std::span<const TrainingCamera> cameras, const WorkFolder& folder,
                Workers& workers) {
  CellRows rows = read_cell_rows(split, cell, folder);
  const std::vector<uint8_t> levels = levels_of(split.spool.inputs, rows.sources);
  const TreeLayout layout = find_layout(rows.cloud, split.origin, rule, workers, {},
                                        {cameras, split.spool.unseen_level, levels});
  const uint32_t shared = cell_levels(layout.child_count)[kSharedLevels];
  const CellTree tree = merge_cell(std::move(rows), layout, split.origin, workers);
  std::vector<NodeRow> nodes;
  for (uint32_t node = 0; node < shared; ++node) nodes.push_back(row_of(tree.baked, node));
  Packer leaves, shape;
  leaves.put_all(layout.leaf).put_all(layout.exposure).put_all(layout.footprint);
  shape.put_all(nodes).put_all(layout.child_count);
  write_sealed(folder.file(cell_leaves_name(cell)), leaves.bytes());
  write_sealed(folder.file(cell_tree_name(cell)), shape.bytes());
}

CellTree rebuild_cell(const SplitInfo& split, uint32_t cell, const WorkFolder& folder,
                      Workers& workers) {
  TreeLayout layout;
  layout.child_count = read_cell_shape(cell, folder);
  read_leaves(split.cell_sizes.at(cell), cell, folder, layout);
  return merge_cell(read_cell_rows(split, cell, folder), layout, split.origin, workers);
}

std::vector<uint8_t> read_cell_shape(uint32_t cell, const WorkFolder& folder) {
  return read_tree(cell, folder).child_count;
}

std::vector<NodeRow> read_cell_nodes(uint32_t cell, const WorkFolder& folder) {
  return read_tree(cell, folder).nodes;
}

}  // namespace voyager
