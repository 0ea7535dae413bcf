#pragma once
#include <span>

#include "runtime/frame/scene.h"

namespace voyager {

// What of a tree weights read beside the search's records, by node.
struct NodeLinks {
  const uint32_t* parent;     // null for a streamed scene
  const NodeRecord* records;  // of all nodes; null where the scene does without
  float blend_share;          // LodTree's
  // Of a scene without records: of a compact one its shapes and large families, else the counts.
  const uint32_t* child_count = nullptr;
  const ShapeCode* shapes = nullptr;
  std::span<const LargeFamily> large{};
  const uint32_t* root_parents = nullptr;  // of a streamed scene, by a subtree's place

  uint32_t parent_of_root(uint32_t place, uint32_t root) const {
    return root_parents != nullptr ? root_parents[place] : parent[root];
  }
  uint32_t children(uint32_t node) const {
    if (records != nullptr) return records[node].child_count;
    if (child_count != nullptr) return child_count[node];
    const uint32_t few = shapes[node].rest.children;
    if (few != kManyChildren) return few;
    return children_of(node, large.data(), static_cast<uint32_t>(large.size()));
  }
};

inline NodeLinks links_of(const LodTree& tree) {
  return {tree.parent.data(), tree.records.empty() ? nullptr : tree.records.data(),
          tree.blend_share};
}

inline NodeLinks node_links(const Scene& scene) {
  NodeLinks links = links_of(scene.tree);
  if (!scene.child_count.empty()) links.child_count = scene.child_count.data();
  if (!scene.shapes.empty()) links.shapes = scene.shapes.data();
  links.large = scene.large_families;
  if (!scene.root_parents.empty()) links.root_parents = scene.root_parents.data();
  return links;
}

}  // namespace voyager
