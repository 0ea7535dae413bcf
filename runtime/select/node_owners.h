#pragma once
// Which subtree owns a node of a scene that is resident: some two bytes a node. Within a level
// the nodes of a subtree are consecutive, and in the order of subtrees.
#include <cstdint>
#include <vector>

#include "runtime/math/run_index.h"
#include "runtime/select/search_tree.h"

namespace voyager {

// As searches read them. Of nodes that are in a subtree.
struct NodeOwners {
  const RunBlock* runs;      // by node; null: none
  const uint32_t* subtrees;  // by run

  VOYAGER_HD uint32_t operator()(uint32_t node) const { return subtrees[run_of(runs, node)]; }
};

struct OwnerRuns {
  std::vector<RunBlock> runs;
  std::vector<uint32_t> subtrees;

  NodeOwners view() const { return {runs.data(), subtrees.data()}; }
};

// tree: of a resident scene, of which no chunk is damaged. Throws only std::bad_alloc.
OwnerRuns make_owner_runs(const SearchTree& tree);

}  // namespace voyager
