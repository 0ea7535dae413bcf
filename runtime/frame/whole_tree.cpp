#include "runtime/frame/whole_tree.h"

#include <algorithm>

#include "runtime/frame/node_links.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager {
namespace {

void fill_interior(const SearchTree& search, LodTree& tree) {
  for (const SearchSubtree& subtree : search.subtrees) {
    uint32_t record = subtree.first_record;
    for (uint32_t slots = subtree.interior; slots != 0; slots &= slots - 1, ++record) {
      const NodeBounds from = search.records[record].bounds();
      NodeRecord& to = tree.records[subtree.node(static_cast<uint32_t>(std::countr_zero(slots)))];
      to.box_min = from.box_min;
      to.box_max = from.box_max;
      to.extent = from.extent;
    }
  }
}

}  // namespace

void leave_out_records(Scene& scene) {
  const auto& records = scene.tree.records;
  if (is_coded(scene))
    for (size_t n = 0; n < records.size(); ++n)
      if (records[n].child_count >= kManyChildren)
        scene.large_families.push_back({static_cast<uint32_t>(n), records[n].child_count});
  if (scene.search.leaves_have_extent || !scene.damaged_chunks.empty()) return;
  const auto drop = [](auto& array) {
    std::decay_t<decltype(array)>(array.get_allocator()).swap(array);
  };
  if (!is_coded(scene)) {
    scene.child_count.resize(records.size());
    std::transform(records.begin(), records.end(), scene.child_count.begin(),
                   [](const NodeRecord& r) { return r.child_count; });
  }
  drop(scene.tree.records);
  drop(scene.tree.first_child);
}

std::shared_ptr<const LodTree> whole_tree(const Scene& scene) {
  const size_t nodes = scene.tree.parent.size();
  if (scene.tree.records.size() == nodes) return {std::shared_ptr<void>(), &scene.tree};
  auto tree = std::make_shared<LodTree>();
  const NodeLinks links = node_links(scene);
  tree->blend_share = scene.tree.blend_share;
  tree->parent.assign(scene.tree.parent.begin(), scene.tree.parent.end());
  tree->records.resize(nodes);
  tree->first_child.resize(nodes);
  uint32_t first_child = 1;
  for (uint32_t n = 0; n < nodes; ++n) {
    tree->records[n].child_count = links.children(n);
    tree->first_child[n] = first_child;
    first_child += tree->records[n].child_count;
  }
  fill_interior(scene.search, *tree);
  for (size_t n = 1; n < nodes; ++n)
    if (tree->records[n].child_count == 0) {
      NodeRecord& leaf = tree->records[n];
      const NodeRecord& parent = tree->records[tree->parent[n]];
      leaf.box_min = parent.box_min;
      leaf.box_max = parent.box_max;
    }
  return tree;
}

}  // namespace voyager
