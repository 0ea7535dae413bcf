#pragma once
// The arrays that searches read, on the device: shared by all views of a scene.
#include "cuda/device/buffer.h"
#include "runtime/lod/tree.h"
#include "runtime/select/node_owners.h"
#include "runtime/select/search_tree.h"

namespace voyager::cuda {

// As kernels take it.
struct TreeView {
  const SearchSubtree* subtrees;  // by place
  SubtreePlaces places;
  const SearchRecord* records;
  const uint32_t* next_block;  // of a streamed scene, as SearchTree's
  const SearchChunk* chunks;
  const NodeRecord* leaves;  // all nodes by id, where leaves have extents; else null
  uint32_t subtree_count, place_count;
  uint32_t chunk_count;  // rows of `chunks`: of a streamed scene one a slot
  float blend_share;     // LodTree's

  // Then nodes and records are addresses.
  VOYAGER_HD bool streamed() const { return next_block != nullptr; }
};

class DevicePool;

// What the partitioned searches need.
class DeviceTree {
 public:
  DeviceTree(const SearchTree& search, const LodTree& tree);
  // Of a streamed scene: its pool's, which outlives this.
  explicit DeviceTree(const DevicePool& pool) : pool_(&pool) {}

  // For a frame: a pool may have another size in the next.
  TreeView view() const;
  // None of a streamed scene: its pool has them.
  NodeOwners owners() const { return {owner_runs_.data(), run_subtrees_.data()}; }

 private:
  Buffer<SearchSubtree> subtrees_;
  Buffer<SearchRecord> records_;
  Buffer<SearchChunk> chunks_;
  Buffer<NodeRecord> leaves_;
  Buffer<RunBlock> owner_runs_;
  Buffer<uint32_t> run_subtrees_;
  TreeView view_{};
  const DevicePool* pool_ = nullptr;
};

}  // namespace voyager::cuda
