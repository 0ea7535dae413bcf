#pragma once
// The topology of a tree, apart from what its nodes hold: what a builder decides, and
// what a bake in parts keeps of a tree that it builds again.
#include <cstdint>
#include <vector>

#include "runtime/lod/baked_scene.h"
#include "runtime/lod/exposure.h"

namespace voyager {

// The topology of a tree over a cloud, and which Gaussian each leaf is.
struct TreeLayout {
  std::vector<uint8_t> child_count;    // of each node, breadth-first; 0: a leaf
  std::vector<uint32_t> leaf;          // of each leaf, in the order of nodes: its Gaussian
  std::vector<ExposureCode> exposure;  // of each leaf; empty: all is seen
  std::vector<uint8_t> footprint;      // of each leaf: its level (node_code.h); empty: 0
};

// Fills the topology of baked.tree, `gaussian`, footprints of leaves, and the room for
// merged Gaussians: of interior nodes, in their order. Returns the first node of each level, and
// the number of nodes last; nothing for an empty layout.
std::vector<uint32_t> lay_out_scene(const TreeLayout& layout, BakedScene& baked);

}  // namespace voyager
