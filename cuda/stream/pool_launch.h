#pragma once
// The kernels of a pool, which read mapped memory.
#include <cuda_runtime_api.h>

#include "cuda/scene/device_tree.h"
#include "cuda/stream/pool_layout.h"

namespace voyager::cuda {

// Chunks that are filled together. They lie one behind another, each as PoolLayout has one chunk.
struct PoolFill {
  static constexpr uint32_t kMostChunks = 16;

  struct Array {
    size_t from, to;      // where it begins in a chunk's memory, and in the pool's
    uint32_t slot_bytes;  // in the pool; 0 of blocks
    uint32_t unit;        // bytes of an element; a multiple of 16, of 4, or any
  };
  struct Chunk {
    uint32_t slot;
    uint32_t counts[kPoolCounts];
  };
  const unsigned char* from;
  unsigned char* to;
  size_t chunk_bytes;
  uint32_t chunk_count;
  Array arrays[kFilledArrays];
  Chunk chunks[kMostChunks];
};

// What links chunks, to be written to.
struct PoolTables {
  SearchSubtree* subtrees;
  uint32_t* pages;
  SearchRecord* records;
  uint32_t* outside;
  SearchChunk* chunks;  // by slot
  LargeFamily* large;   // null where they are not asked for
  uint32_t* large_count;
};

// LinkPatch as kernels read it.
struct PoolPatch {
  const LinkPatch::Record* cut;
  const LinkPatch::Record* tied;
  const SearchSubtree* linked;
  const LinkPatch::Outside* outside;
  const uint32_t* linked_subtrees;  // of each of linked
  const uint32_t* unlinked;
  const uint32_t* left;
  const SearchChunk* arrived;
  const uint32_t* arrived_slots;  // of each of arrived
  const PageChange* pages;
  const LargeFamily* large;
  uint32_t cut_count, tied_count, linked_count, outside_count, unlinked_count, left_count,
      arrived_count, page_count, large_count;
  bool large_changed;
};

void launch_fill(const PoolFill& fill, cudaStream_t stream);
// In the order of runtime/stream/link_patch.h.
void launch_patch(const PoolTables& tables, const PoolPatch& patch, cudaStream_t stream);
// Of subtrees that have not come yet, by place.
void launch_unlink_all(SearchSubtree* subtrees, uint32_t count, cudaStream_t stream);

}  // namespace voyager::cuda
