#pragma once
// The tree of a .hier, breadth-first as ours is (runtime/lod/tree.h).
#include <cstdint>
#include <vector>

#include "runtime/scene/further_gaussians.h"
#include "runtime/scene/import/hier/file.h"

namespace voyager::hier {

struct Tree {
  // Of each node. A node without children is a leaf, also where the file has it as an inner one.
  std::vector<uint32_t> child_count;
  std::vector<uint32_t> gaussian;  // the first of those that the file gives the node
  std::vector<uint32_t> file_node;
  std::vector<FurtherCount> further;  // of nodes with several: those after the first
  uint64_t unused = 0;                // Gaussians that no node has
  uint64_t childless = 0;             // inner nodes without children
};

// Memory: 44 bytes a node, 8 more where one has several Gaussians. Throws Error(refused_input)
// naming the node where the links are no tree over all nodes, each with Gaussians of its own.
Tree read_tree(const File& file);

// Ascending.
std::vector<uint32_t> leaf_gaussians(const Tree& tree);

}  // namespace voyager::hier
