#pragma once
// The kernels of a pool, which read mapped memory.
#include <cuda_runtime_api.h>

#include "cuda/scene/device_tree.h"
#include "cuda/stream/pool_layout.h"

namespace voyager::cuda {

// Words of 16, 4 or 1 bytes, both sides aligned to them.
struct PoolCopy {
  const void* from;
  void* to;
  uint32_t words, word_bytes;
};
struct PoolFill {
  PoolCopy copies[kFilledArrays];
};

// What links chunks, to be written to.
struct PoolTables {
  SearchSubtree* subtrees;
  uint32_t* pages;
  SearchRecord* records;
  uint32_t* outside;
  LargeFamily* large;  // null where they are not asked for
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
  const PageChange* pages;
  const LargeFamily* large;
  uint32_t cut_count, tied_count, linked_count, outside_count, unlinked_count, page_count,
      large_count;
  bool large_changed;
};

void launch_fill(const PoolFill& fill, cudaStream_t stream);
// In its order (runtime/stream/linker.h).
void launch_patch(const PoolTables& tables, const PoolPatch& patch, cudaStream_t stream);
// Of subtrees that have not come yet, by place.
void launch_unlink_all(SearchSubtree* subtrees, uint32_t count, cudaStream_t stream);

}  // namespace voyager::cuda
