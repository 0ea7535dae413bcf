#pragma once
// The buffers of the stages from projection on. They grow between frames, never in one.
#include <algorithm>
#include <array>

#include "cuda/device/buffer.h"
#include "cuda/search/search.h"
#include "cuda/splat/splats.h"

namespace voyager::cuda {

// Of the buffers that the scene and the view decide.
struct SplatRoom {
  size_t places = 0, slots = 0, strips = 0, pairs = 0;

  bool holds(const SplatRoom& other) const {
    return places >= other.places && slots >= other.slots && strips >= other.strips &&
           pairs >= other.pairs;
  }
};

// A frame draws its tiles once, or once more those that their limits left open.
inline constexpr int kPasses = 2;
using PassCounters = std::array<SplatCounters, kPasses>;

// What a frame's lists would have needed.
SplatRoom room_for(const PassCounters& passes);

// The eyes' tiles, one grid behind the other.
FrameTiles frame_tiles(const FrameInput& frame);

// Pairs, strips, slots and places of a frame for which there was no room.
uint64_t dropped(const PassCounters& passes, const SplatRoom& room);

class SplatState {
 public:
  // bin_blocks: of bin.cu.
  SplatState(unsigned bin_blocks, uint32_t eyes);

  // Whether there is room for the tiles.
  bool fits(const FrameTiles& tiles) const { return tiles.count() <= tiles_.size(); }
  // Makes room for the tiles; what is there already stays. Nothing on the device uses the buffers.
  // Throws Error.
  void fit(const FrameTiles& tiles);
  // Buffers that belong together may differ after an allocation that failed.
  SplatRoom room() const {
    return {std::min({rows_.size(), ranks_.size(), rank_sums_.size() * kSumRows}) * kRowPlaces,
            std::min({records_.size() / eyes_, whole_.size(), blended_.size()}), strips_.size(),
            std::min(keys_.size(), merge_keys_.size())};
  }
  // Makes so much room, with some to spare. False where there is nothing to do, or no
  // memory for it: the frame is then what it can be. Nothing on the device uses them.
  bool grow(const SplatRoom& wanted);

  // Clears what the kernels add to, in both passes. Before view().
  void begin_frame(const FrameTiles& tiles, cudaStream_t stream);
  // Of that pass; its limits are not set.
  SplatView view(const FrameTiles& tiles, int pass) const;
  const PassCounters* counters() const {
    return reinterpret_cast<const PassCounters*>(counters_.data());
  }

 private:
  bool grow_places(size_t wanted);
  bool grow_slots(size_t wanted);
  bool grow_strips(size_t wanted);
  bool grow_pairs(size_t wanted);

  unsigned bin_blocks_;
  uint32_t eyes_;
  uint32_t rank_tag_ = 0;  // no older sum has a tag from here on
  Buffer<uint32_t> rows_;
  Buffer<RankRow> ranks_;
  Buffer<unsigned long long> rank_sums_;
  Buffer<SplatRecord> records_;
  Buffer<Candidate> whole_, blended_;
  Buffer<DepthKey> keys_, merge_keys_;
  Buffer<unsigned char> counters_;  // PassCounters, then a count a tile and pass, then the ends
  Buffer<TileStrip> strips_;
  Buffer<uint32_t> tile_offsets_, tile_order_;
  Buffer<TileList> tiles_;
};

}  // namespace voyager::cuda
