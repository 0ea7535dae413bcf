#pragma once
// The buffers of the stages from projection on. They grow between frames, never in one.
#include <algorithm>

#include "cuda/buffer.h"
#include "cuda/splats.h"

namespace voyager::cuda {

class SplatState {
 public:
  // bin_blocks: of bin.cu.
  explicit SplatState(unsigned bin_blocks);

  // Makes room for the tiles of the grid; what is there already stays. Throws Error.
  void fit(const TileGrid& grid);
  // Makes room for what a frame has counted, with some to spare. False where there is
  // nothing to do, or no memory for it: the frame is then what it can be.
  bool grow(const SplatCounters& counters);
  // Pairs, strips and places of the frame for which there was no room.
  uint64_t dropped(const SplatCounters& counters) const;

  SplatView view(const TileGrid& grid) const;
  // Clears what the kernels add to.
  void begin_frame(const TileGrid& grid, cudaStream_t stream) const;
  const SplatCounters* counters() const {
    return reinterpret_cast<const SplatCounters*>(counters_.data());
  }

 private:
  // Buffers that belong together may differ after an allocation that failed.
  size_t slots() const { return std::min(records_.size(), candidates_.size()); }
  size_t pairs() const { return std::min(keys_.size(), merge_keys_.size()); }
  bool grow_slots(size_t wanted);
  bool grow_strips(size_t wanted);
  bool grow_pairs(size_t wanted);

  unsigned bin_blocks_;
  Buffer<SplatRecord> records_;
  Buffer<uint32_t> candidates_;
  Buffer<DepthKey> keys_, merge_keys_;
  Buffer<unsigned char> counters_;  // SplatCounters, then a count a tile
  Buffer<TileStrip> strips_;
  Buffer<uint32_t> tile_offsets_, tile_order_;
  Buffer<TileList> tiles_;
};

}  // namespace voyager::cuda
