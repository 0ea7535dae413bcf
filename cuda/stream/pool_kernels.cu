#include <algorithm>

#include "cuda/device/launch.cuh"
#include "cuda/stream/pool_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;
// A chunk is some 8 KB in a dozen arrays: that many blocks ask for all of it at once.
constexpr unsigned kMostBlocks = 64;

unsigned blocks_for(uint32_t threads) {
  return std::clamp((threads + kThreads - 1) / kThreads, 1u, kMostBlocks);
}

__device__ uint32_t first_index() {
  return blockIdx.x * kThreads + threadIdx.x;
}
__device__ uint32_t stride() {
  return gridDim.x * kThreads;
}

template <class Word>
__device__ void copy_words(const PoolCopy& copy) {
  const Word* from = static_cast<const Word*>(copy.from);
  Word* to = static_cast<Word*>(copy.to);
  for (uint32_t i = first_index(); i < copy.words; i += stride()) to[i] = from[i];
}

// A chunk's records go to its blocks, of which each says which is next.
__device__ void copy_records(const PoolFill& fill) {
  constexpr uint32_t kWords = kRecordBlock * sizeof(SearchRecord) / sizeof(uint4);
  const auto* blocks = static_cast<const uint32_t*>(fill.copies[kNextBlocks].from);
  const PoolCopy& copy = fill.copies[kRecords];
  const uint4* from = static_cast<const uint4*>(copy.from);
  uint4* to = static_cast<uint4*>(copy.to);
  for (uint32_t i = first_index(); i < copy.words; i += stride())
    to[size_t{blocks[i / kWords]} * kWords + i % kWords] = from[i];
}
__device__ void chain_blocks(const PoolCopy& copy) {
  const auto* blocks = static_cast<const uint32_t*>(copy.from);
  uint32_t* next = static_cast<uint32_t*>(copy.to);
  for (uint32_t i = first_index(); i + 1 < copy.words; i += stride())
    next[blocks[i]] = blocks[i + 1];
}

// An array each row of thread blocks, so that none waits for another's reads.
__global__ void __launch_bounds__(kThreads) pool_fill(PoolFill fill) {
  const PoolCopy& copy = fill.copies[blockIdx.y];
  if (blockIdx.y == kRecords)
    copy_records(fill);
  else if (blockIdx.y == kNextBlocks)
    chain_blocks(copy);
  else if (copy.word_bytes == sizeof(uint4))
    copy_words<uint4>(copy);
  else if (copy.word_bytes == sizeof(uint32_t))
    copy_words<uint32_t>(copy);
  else
    copy_words<uint8_t>(copy);
}

__device__ SubtreePlaces places_of(const PoolTables& tables) {
  return {tables.pages};
}

__device__ void set_records(const PoolTables& tables, const LinkPatch::Record* records,
                            uint32_t count) {
  for (uint32_t i = first_index(); i < count; i += stride()) {
    const LinkPatch::Record r = records[i];
    tables.records[r.record].children = r.children;
  }
}

__global__ void __launch_bounds__(kThreads) pool_cut(PoolTables tables, PoolPatch patch) {
  set_records(tables, patch.cut, patch.cut_count);
  for (uint32_t i = first_index(); i < patch.unlinked_count; i += stride())
    tables.subtrees[places_of(tables)(patch.unlinked[i])].entry = kNotLinked;
}

__global__ void __launch_bounds__(kThreads) pool_place(PoolTables tables, PoolPatch patch) {
  for (uint32_t i = first_index(); i < patch.page_count * kPageSubtrees; i += stride()) {
    const PageChange change = patch.pages[i / kPageSubtrees];
    const uint32_t subtree = i % kPageSubtrees;
    if (subtree == 0) tables.pages[change.page] = change.place;
    if (change.place != 0)
      tables.subtrees[change.place * kPageSubtrees + subtree] = kUnlinkedSubtree;
  }
}

__global__ void __launch_bounds__(kThreads) pool_tie(PoolTables tables, PoolPatch patch) {
  const SubtreePlaces places = places_of(tables);
  set_records(tables, patch.tied, patch.tied_count);
  for (uint32_t i = first_index(); i < patch.linked_count; i += stride())
    tables.subtrees[places(patch.linked_subtrees[i])] = patch.linked[i];
  for (uint32_t i = first_index(); i < patch.outside_count; i += stride()) {
    const LinkPatch::Outside o = patch.outside[i];
    tables.outside[places(o.subtree)] = o.parent;
  }
  if (!patch.large_changed || tables.large == nullptr) return;
  for (uint32_t i = first_index(); i < patch.large_count; i += stride())
    tables.large[i] = patch.large[i];
  if (first_index() == 0) *tables.large_count = patch.large_count;
}

__global__ void __launch_bounds__(kThreads)
    pool_unlink_all(SearchSubtree* subtrees, uint32_t count) {
  for (uint32_t i = first_index(); i < count; i += stride()) subtrees[i] = kUnlinkedSubtree;
}

}  // namespace

void launch_fill(const PoolFill& fill, cudaStream_t stream) {
  uint32_t most = 0;
  for (const PoolCopy& copy : fill.copies) most = std::max(most, copy.words);
  launch_kernel("pool_fill", pool_fill, {dim3(blocks_for(most), kFilledArrays), kThreads, stream},
                fill);
}

void launch_patch(const PoolTables& tables, const PoolPatch& patch, cudaStream_t stream) {
  if (const uint32_t most = std::max(patch.cut_count, patch.unlinked_count); most != 0) {
    launch_kernel("pool_cut", pool_cut, {blocks_for(most), kThreads, stream}, tables, patch);
  }
  if (patch.page_count != 0)
    launch_kernel("pool_place", pool_place,
                  {blocks_for(patch.page_count * kPageSubtrees), kThreads, stream}, tables, patch);
  if (const uint32_t most =
          std::max({patch.tied_count, patch.linked_count, patch.outside_count, patch.large_count});
      most != 0 || patch.large_changed) {
    launch_kernel("pool_tie", pool_tie, {blocks_for(most), kThreads, stream}, tables, patch);
  }
}

void launch_unlink_all(SearchSubtree* subtrees, uint32_t count, cudaStream_t stream) {
  launch_kernel("pool_unlink_all", pool_unlink_all, {blocks_for(count), kThreads, stream}, subtrees,
                count);
}

}  // namespace voyager::cuda
