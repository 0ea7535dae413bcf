#include "runtime/frame/whole_tree.h"

#include <algorithm>

namespace voyager {
namespace {

void fill_interior(const SearchTree& search, LodTree& tree) {
  for (const SearchSubtree& subtree : search.subtrees) {
    uint32_t record = subtree.first_record;
    for (uint32_t slots = subtree.interior; slots != 0; slots &= slots - 1, ++record) {
      const SearchRecord& from = search.records[record];
      NodeRecord& to = tree.records[subtree.node(static_cast<uint32_t>(std::countr_zero(slots)))];
      to.box_min = from.box_min;
      to.box_max = from.box_max;
      to.extent = from.extent;
    }
  }
}

}  // namespace

void leave_out_records(Scene& scene) {
  if (scene.search.leaves_have_extent || !scene.damaged_chunks.empty()) return;
  const auto drop = [](auto& array) {
    std::decay_t<decltype(array)>(array.get_allocator()).swap(array);
  };
  scene.child_count.resize(scene.tree.records.size());
  std::transform(scene.tree.records.begin(), scene.tree.records.end(), scene.child_count.begin(),
                 [](const NodeRecord& r) { return r.child_count; });
  drop(scene.tree.records);
  drop(scene.tree.first_child);
}

std::shared_ptr<const LodTree> whole_tree(const Scene& scene) {
  if (scene.child_count.empty()) return {std::shared_ptr<void>(), &scene.tree};
  auto tree = std::make_shared<LodTree>();
  const size_t nodes = scene.child_count.size();
  tree->blend_share = scene.tree.blend_share;
  tree->parent.assign(scene.tree.parent.begin(), scene.tree.parent.end());
  tree->records.resize(nodes);
  tree->first_child.resize(nodes);
  uint32_t first_child = 1;
  for (size_t n = 0; n < nodes; ++n) {
    tree->records[n].child_count = scene.child_count[n];
    tree->first_child[n] = first_child;
    first_child += scene.child_count[n];
  }
  fill_interior(scene.search, *tree);
  for (size_t n = 1; n < nodes; ++n)
    if (scene.child_count[n] == 0) {
      NodeRecord& leaf = tree->records[n];
      const NodeRecord& parent = tree->records[tree->parent[n]];
      leaf.box_min = parent.box_min;
      leaf.box_max = parent.box_max;
    }
  return tree;
}

}  // namespace voyager
