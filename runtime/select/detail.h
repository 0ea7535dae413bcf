#pragma once
// What a frame draws of a tree, and the other ways to choose it that literature has: baselines.
// Each is a tree of the same topology with other sizes, so that every search finds it, on every
// backend, and nothing downstream knows of it.
#include "runtime/select/cut.h"
#include "runtime/select/search_tree.h"

namespace voyager {

enum class Lod {
  cut,         // each node by its own size (METHOD §3)
  all_leaves,  // as 3DGS
  // A baseline, as CityGaussian chooses: the scene in blocks, all of a block at one depth of the
  // tree, by the block's distance. A block is what hangs from a node of the first level that has
  // kBlocks nodes. The depth is the first on which the mean extent of the block's nodes, seen from
  // as far as the block's box, is below τ*.
  blocks,
  // A baseline, as Octree-GS chooses: each node has a level, the logarithm of its extent to base
  // 2, rounded up, and is refined where that is above the level that its distance asks for,
  // log2(τ* · distance).
  levels,
};

inline bool draws_cut(Lod lod) {
  return lod != Lod::all_leaves;
}

inline constexpr size_t kBlocks = 64;

// Whose weights make t what `lod` has it. Neither baseline interpolates: with a target of 0 t is 1
// everywhere.
inline CutQuery weights_query(Lod lod, const CutQuery& query) {
  return lod == Lod::cut ? query : CutQuery{query.centre, 0.0f};
}

struct DetailTree {
  LodTree tree;
  SearchTree search;
};

// lod: blocks or levels. The tree is sound, the partition its own. What levels find for a query is
// nowhere coarser than the cut. O(n), 40 bytes a node and a search tree from `memory`. Throws only
// std::bad_alloc.
DetailTree make_detail_tree(const LodTree& tree, const Partition& partition, Lod lod,
                            Workers& workers, std::pmr::memory_resource* memory);

}  // namespace voyager
