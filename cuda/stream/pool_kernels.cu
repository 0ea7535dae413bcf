#include <algorithm>

#include "cuda/device/launch.cuh"
#include "cuda/stream/pool_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;
// Of what is copied for one chunk, or linked.
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
__device__ void copy_words(const unsigned char* from, unsigned char* to, uint32_t bytes) {
  for (uint32_t i = first_index(); i < bytes / sizeof(Word); i += stride())
    reinterpret_cast<Word*>(to)[i] = reinterpret_cast<const Word*>(from)[i];
}

// A chunk's records go to its blocks, of which each says which is next.
__device__ void copy_records(const uint32_t* blocks, const unsigned char* from, unsigned char* to,
                             uint32_t bytes) {
  constexpr uint32_t kWords = kRecordBlock * sizeof(SearchRecord) / sizeof(uint4);
  for (uint32_t i = first_index(); i < bytes / sizeof(uint4); i += stride())
    reinterpret_cast<uint4*>(to)[size_t{blocks[i / kWords]} * kWords + i % kWords] =
        reinterpret_cast<const uint4*>(from)[i];
}
__device__ void chain_blocks(const uint32_t* blocks, uint32_t* next, uint32_t count) {
  for (uint32_t i = first_index(); i + 1 < count; i += stride()) next[blocks[i]] = blocks[i + 1];
}

// An array and a chunk each row of thread blocks, so that none waits for another's reads.
__global__ void __launch_bounds__(kThreads) pool_fill(PoolFill fill) {
  const PoolFill::Array& array = fill.arrays[blockIdx.y];
  const PoolFill::Chunk& chunk = fill.chunks[blockIdx.z];
  const unsigned char* piece = fill.from + blockIdx.z * fill.chunk_bytes;
  const unsigned char* from = piece + array.from;
  unsigned char* to = fill.to + array.to + size_t{chunk.slot} * array.slot_bytes;
  const uint32_t count = chunk.counts[counted_by(blockIdx.y)], bytes = count * array.unit;
  const auto* blocks = reinterpret_cast<const uint32_t*>(piece + fill.arrays[kNextBlocks].from);
  if (blockIdx.y == kRecords)
    copy_records(blocks, from, to, bytes);
  else if (blockIdx.y == kNextBlocks)
    chain_blocks(blocks, reinterpret_cast<uint32_t*>(to), count);
  else if (word_bytes(array.unit) == sizeof(uint4))
    copy_words<uint4>(from, to, bytes);
  else if (word_bytes(array.unit) == sizeof(uint32_t))
    copy_words<uint32_t>(from, to, bytes);
  else
    copy_words<uint8_t>(from, to, bytes);
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
  for (uint32_t i = first_index(); i < patch.left_count; i += stride())
    tables.chunks[patch.left[i]] = SearchChunk{};
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
  for (uint32_t i = first_index(); i < patch.arrived_count; i += stride())
    tables.chunks[patch.arrived_slots[i]] = patch.arrived[i];
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
  uint32_t most = 1;
  for (uint32_t a = 0; a < kFilledArrays; ++a)
    for (uint32_t c = 0; c < fill.chunk_count; ++c) {
      const uint32_t unit = fill.arrays[a].unit, count = fill.chunks[c].counts[counted_by(a)];
      most = std::max(most, count * unit / word_bytes(unit));
    }
  launch_kernel("pool_fill", pool_fill,
                {dim3(blocks_for(most), kFilledArrays, fill.chunk_count), kThreads, stream}, fill);
}

void launch_patch(const PoolTables& tables, const PoolPatch& patch, cudaStream_t stream) {
  if (const uint32_t most = std::max({patch.cut_count, patch.unlinked_count, patch.left_count});
      most != 0) {
    launch_kernel("pool_cut", pool_cut, {blocks_for(most), kThreads, stream}, tables, patch);
  }
  if (patch.page_count != 0)
    launch_kernel("pool_place", pool_place,
                  {blocks_for(patch.page_count * kPageSubtrees), kThreads, stream}, tables, patch);
  if (const uint32_t most = std::max({patch.tied_count, patch.linked_count, patch.outside_count,
                                      patch.arrived_count, patch.large_count});
      most != 0 || patch.large_changed) {
    launch_kernel("pool_tie", pool_tie, {blocks_for(most), kThreads, stream}, tables, patch);
  }
}

void launch_unlink_all(SearchSubtree* subtrees, uint32_t count, cudaStream_t stream) {
  launch_kernel("pool_unlink_all", pool_unlink_all, {blocks_for(count), kThreads, stream}, subtrees,
                count);
}

}  // namespace voyager::cuda
