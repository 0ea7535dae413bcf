#pragma once
// Parts of a scene that learn one after another, each small enough for the trainer's memory. A part
// is a scene of its own: what lies around it stands there as leaves, which never change.
#include <cstdint>
#include <vector>

#include "runtime/lod/baked_scene.h"

namespace voyager {

// Consecutive siblings: all below them learns together.
struct PartRoots {
  uint32_t first, count;  // nodes
  uint64_t leaves;        // below them
};

// The largest runs of siblings with at most so many leaves below them, ascending. Runs without a
// merged node are left out: there is nothing to learn. At least 1.
std::vector<PartRoots> part_roots(const LodTree& tree, uint64_t most_leaves);

struct ScenePart {
  BakedScene scene;
  // Leaves that views look at: the scene's first ones. The others are what lies around.
  size_t own_leaves = 0;
  double leaf_size = 0;  // metres: the median extent of nodes that stand as own leaves, or 0
  double largest = 0;    // metres: the roots' greatest extent, or 0
  // By node of `scene`, the whole's; kNoNode for a root that only holds the part and what is around
  // it together, and is in no cut.
  std::vector<uint32_t> whole;
};

// All below the roots, and around it the finest nodes, by their size as seen from the part, of
// which there are at most so many (more only where siblings of the part's ancestors alone are
// more).
ScenePart take_part(const BakedScene& whole, const PartRoots& roots, uint64_t most_around);

// All above the finest nodes, by extent, of which there are about so many at most. They stand as
// leaves.
ScenePart take_top(const BakedScene& whole, uint64_t most_leaves);

// Puts the part's merged Gaussians and extents into the whole, of nodes that are not `kept`. The
// whole's tree is to be mended then (never_grow_downwards(), align_children()).
void give_back(const ScenePart& part, const std::vector<bool>& kept, BakedScene& whole);

}  // namespace voyager
