#pragma once
// What the stages from projection on hand to one another, on the device.
#include <cuda_runtime_api.h>

#include <cstdint>

#include "cuda/search/row_places.h"
#include "cuda/splat/tile_limits.h"
#include "runtime/math/count_bits.h"
#include "runtime/stages/bin.h"

namespace voyager::cuda {

// A projected splat; log α of a pixel is log_opacity - (p² + q²), all in the conic's base.
struct alignas(16) SplatRecord {
  float x, y, p_x, q_y;
  float skew, log_opacity, depth, t;
  float r, g, b, inverse_k;
};
static_assert(sizeof(SplatRecord) == 48);

// The grown support of a splat from its record, in every stage alike.
// log_threshold: of α*, natural.
VOYAGER_HD SupportEllipse support_of(const SplatRecord& r, float log_scale, float log_threshold) {
  const Rounded threshold = Rounded(log_threshold) * log_scale;
  return support_ellipse(r.x, r.y, {r.p_x, r.skew, r.q_y}, (threshold - r.log_opacity).value);
}

// A (tile, splat) pair in its tile's list: the bits of z > 0 above the splat's slot. An eye's
// slots ascend with ranks, so that keys are in the contract's order.
using DepthKey = unsigned long long;

VOYAGER_HD uint32_t slot_of(DepthKey key) {
  return static_cast<uint32_t>(key);
}

// Strips are appended in as many places, or all warps would wait for one counter. Each eye has as
// many of them, the first eye the first ones.
inline constexpr uint32_t kStripRegions = 32;
struct alignas(128) StripRegion {
  uint32_t strips;
};

// Warps take short lists from as many queues: whoever has sorted a long one takes fewer. The i-th
// of these lists is in queue i mod kSortQueues.
inline constexpr uint32_t kSortQueues = 32;
struct alignas(128) SortQueue {
  uint32_t taken;
};

// A place that may reach the image, and the weight of its node.
struct Candidate {
  uint32_t place;
  float weight;
};

// Of consecutive ranks, which are the places of all instances in the contract's order (instance,
// id): those that may reach the image, and the slot of the first of them.
struct RankRow {
  uint32_t candidates;  // bits
  uint32_t first_slot;

  VOYAGER_HD bool has(uint32_t rank) const { return (candidates >> rank % kRowPlaces & 1) != 0; }
  // Of a rank that it has.
  VOYAGER_HD uint32_t slot(uint32_t rank) const {
    return first_slot + count_bits(candidates & ((1u << rank % kRowPlaces) - 1));
  }
};

// Of so many, project_slots.cu adds up the candidates: a word of rank_sums for each.
inline constexpr uint32_t kSumRows = 4096;

struct InstanceCounters {
  uint32_t first_rank;  // a multiple of kRowPlaces
  uint32_t first_slot;
  // Of its places, that may reach the image: those that are drawn untouched, and those that blend
  // with their parents.
  uint32_t whole, blended;
  uint32_t rows;  // of its list that may reach the image, where the list has bounds
};

// Of one pass of a frame.
struct SplatCounters {
  StripRegion regions[kStripRegions];
  SortQueue queues[kSortQueues];
  unsigned long long pairs, pairs_boxed;          // of the ellipses, and of their boxes
  unsigned long long evaluated, blended;          // pixels, where they are counted
  unsigned long long places_read;                 // of the lists, where pixels are counted
  InstanceCounters instances[kMaxInstances + 1];  // by SplatFrame::instance
  uint32_t places;                // of the lists that are drawn: behind the last rank
  uint32_t slots;                 // of those that may reach the image
  uint32_t splats;                // that reach the image
  unsigned long long strips;      // of them
  unsigned long long strip_room;  // that they need in all regions
  unsigned long long strips_dropped;
  uint32_t long_lists, large_lists, halved_lists;  // the first tiles of tile_order
  uint32_t open_parts;  // of tiles whose list was cut off before all of their pixels had ended
  OpenTiles open;       // that the pass draws, where it is the second
};

// At most so many keys are in lists behind the long ones, and behind the large ones: just
// under where bin_order's classes begin.
inline constexpr uint32_t kShortList = 511, kMediumList = 2047;

// Thread blocks of rasterize.cu that are resident on a multiprocessor: a block has a tile, or half.
// So a thread has 64 registers; with room for ten blocks, and 48, it took 6 % longer.
inline constexpr unsigned kRasterBlocks = 8;
// Twice as many warps blend a tile whose list is longer than this share of what a resident block
// has of all pairs on average: it would end last. bench/NOTES.md has other shares.
inline constexpr float kHalvedShare = 0.5f;
inline constexpr uint32_t kLeastHalved = 64;       // a list's length: two of its groups of 32
inline constexpr uint32_t kMaxHalvedLists = 1024;  // in a frame: so many blocks more are launched

// A splat in one row of tiles.
struct alignas(16) TileStrip {
  uint32_t slot, depth;        // of its key
  uint32_t first_tile, tiles;  // none: the box reaches the row, the ellipse does not
};

// [first, last) of the pairs.
struct TileList {
  uint32_t first, last;
};

// The tiles of a frame: those of an eye behind those of the eye before it.
struct FrameTiles {
  TileGrid grids[kMaxEyes];
  uint32_t first[kMaxEyes + 1];  // behind the last: as many as there are in all
  uint32_t eyes;

  VOYAGER_HD uint32_t eye(uint32_t tile) const {
    uint32_t eye = 0;
    for (uint32_t other = 1; other < kMaxEyes; ++other) eye += tile >= first[other];
    return eye;
  }
  VOYAGER_HD uint32_t count() const { return first[kMaxEyes]; }
};

// As kernels take it.
struct SplatView {
  SplatRecord* records;        // by slot: of all candidates for an eye, then for the next
  Candidate *whole, *blended;  // of the instance that is being projected
  uint32_t slots;              // room for each of these
  uint32_t* rows;              // of that instance's list
  RankRow* ranks;
  uint32_t places;                // room for ranks
  unsigned long long* rank_sums;  // for project_slots.cu
  uint32_t rank_tag;              // that marks the first instance's sums
  TileStrip* strips;              // kStripRegions regions of equal room
  uint32_t strip_room;            // of all
  DepthKey* keys;
  DepthKey* merge_keys;  // as many
  uint32_t pairs;        // room
  SplatCounters* counters;
  uint32_t* tile_counts;   // behind the counters, so that they are cleared together
  uint32_t* tile_offsets;  // [block of bin_count][tile]
  TileList* tiles;
  uint32_t* tile_order;  // longest lists first
  // By tile, the depth (bits) behind which it is full; kDrawAll where it is not. Of both passes.
  uint32_t* ends;
  TileLimits limits;
  const uint32_t* open_parts;  // of the first pass; null there
  FrameTiles frame;
};

// slot: of the first eye.
VOYAGER_HD uint32_t slot_of(const SplatView& splats, uint32_t slot, uint32_t eye) {
  return eye * splats.slots + slot;
}

VOYAGER_HD uint32_t* strip_count(const SplatView& splats, uint32_t region) {
  return &splats.counters->regions[region].strips;
}

}  // namespace voyager::cuda
