#pragma once
// What a view keeps of its cut between frames, on the device; direct-indexed by
// subtree, or its place, so that no result depends on the order in which warps come by.
#include "cuda/device/buffer.h"
#include "cuda/scene/device_tree.h"
#include "cuda/search/search.h"
#include "cuda/search/segment_windows.h"
#include "runtime/lod/subtrees.h"
#include "runtime/select/visit.h"
#include "runtime/select/watch_row.h"
#include "runtime/stages/reach.h"

namespace voyager::cuda {

inline constexpr uint32_t kBlockSubtrees = 512, kBlockRows = kBlockSubtrees / kRowSubtrees;
inline constexpr uint32_t kLevels = 3;  // of a tier

// How much room segments have where all of them get new places: the first of these that a list has
// room for.
enum class SegmentFit : uint32_t {
  roomy,   // whole rows, and one place in eight to spare: they grow without moving others
  rows,    // the rows that they take, and what rows are left, shared out
  packed,  // the places that they take: neighbours share a row, and where one grows all move
  none     // no cut is as large: an error, which found() and read() throw
};
VOYAGER_HD uint32_t whole_rows(uint32_t places) {
  return (places + kRowPlaces - 1) / kRowPlaces * kRowPlaces;
}
VOYAGER_HD uint32_t segment_room(uint32_t size, SegmentFit fit) {
  if (size == 0 || fit == SegmentFit::none) return 0;
  if (fit == SegmentFit::packed) return size;
  return whole_rows(fit == SegmentFit::rows ? size : size + size / 8 + kRowPlaces);
}

// Consecutive subtrees of one tier. Their cut nodes are in the cut list in three
// segments, one a level; segments lie in the order of node ids (tier, level, block).
struct Block {
  uint32_t first, last;            // subtrees
  uint32_t first_segment, stride;  // the segment of level l is first_segment + l * stride
};

// Blocks [first_block, first_block + blocks) are those of the subtrees from `begin` on.
struct Tier {
  uint32_t begin, first_block, blocks;
};

// The cut nodes of a block's level. `room` may be more than `size`, so that a frame
// rewrites only the segments that changed: the rest of it holds kNoNode.
struct Segment {
  uint32_t size, first, room;
};

// What a window's segments need when they make room for one another, and what they have.
struct WindowPlaces {
  uint32_t need, room;
  VOYAGER_HD bool fits() const { return need <= room; }
};
VOYAGER_HD WindowPlaces operator+(const WindowPlaces& a, const WindowPlaces& b) {
  return {a.need + b.need, a.room + b.room};
}

// Of one frame. The kernels add up StateView::counting; search_place moves it to `counted`, where
// search_emit and the host find it, and clears it for the next frame.
struct FrameCounters {
  unsigned long long nodes_tested, subtrees_visited, chunks_read, bytes_read;
  unsigned long long entered, left;
  // Nodes, places in the list, and nodes that stand in for children that are not resident. They
  // are kept from frame to frame.
  uint32_t cut_size, list_size, stand_ins;
  SegmentFit fit;                // of the segments when they moved last; kept, too
  uint32_t streamed;             // 1: by streaming
  uint32_t due_count;            // entries of due[]
  uint32_t dirty_count;          // entries of dirty[]
  uint32_t open_blocks_changed;  // 1: a block has its first open subtree, or no more
  uint32_t next_chunks;          // streaming's ticket
  uint32_t signal_head, signal_tail, signals_done;
};

// As kernels take it.
struct StateView {
  // By the subtree's place, as the tree's.
  SubtreePlaces places;
  uint32_t place_count;
  Watch* watch;
  uint32_t* refined;   // bits of slots, and kOpen
  uint32_t* cut;       // bits of slots
  uint8_t* stand_ins;  // how many nodes; null where no record is ever blocked
  WatchRow* rows;      // of each block, as many as a whole one has
  const Block* blocks;
  const Tier* tiers;
  uint32_t block_count, tier_count;
  Segment* segments;
  WindowPlaces* windows;  // by window of SegmentWindows: those that were counted in this frame
  uint32_t* open_counts;  // by block: open subtrees
  uint32_t* open_blocks;  // those that had any when the list was last made
  uint32_t* open_block_count;
  uint32_t* dirty_flags;  // by block: in dirty[]
  uint32_t* dirty;        // blocks with nodes that entered or left
  uint32_t* due;          // subtrees to visit
  uint32_t due_room;      // of more of them none is visited: the search streams instead
  uint32_t* signals;      // to open or close a subtree; kNoSignal where not written yet
  FrameCounters *counting, *counted;
  uint32_t* nodes;     // the cut list: ascending, with kNoNode in between
  uint32_t list_room;  // its places
  MeanBounds* bounds;  // of each row
};

inline constexpr uint32_t kNoSignal = 0xffffffffu;
inline constexpr uint32_t kClose = 0x80000000u;  // beside the subtree; else it is to be opened

class CutState {
 public:
  // places: that subtrees have in the device's tree. due: so many are visited at most. most: no cut
  // has more nodes. All memory is taken here.
  CutState(const SearchTree& tree, uint32_t places, uint32_t due, size_t most);
  // What it takes of a streamed scene: for eight places, of which one may be due
  // (an experiment that visits all takes more); for eight nodes of `most`; for the ends of their
  // segments, an eighth of that but never more than most_ends(); and beside them.
  static constexpr uint64_t kEightPlaces =
      8 * (sizeof(Watch) + 3 * sizeof(uint32_t) + sizeof(uint8_t)) + sizeof(uint32_t);
  static uint64_t eight_nodes();
  static uint64_t ends_of_eight();
  static uint64_t most_ends(const SearchTree& tree);
  static uint64_t fixed_bytes(const SearchTree& tree);

  // places: the device's tree's, where its subtrees are read or written.
  StateView view(SubtreePlaces places = {}) const;
  uint32_t list_room() const { return static_cast<uint32_t>(nodes_.size()); }

 private:
  Buffer<Watch> watch_;
  Buffer<WatchRow> rows_;
  Buffer<uint32_t> refined_, cut_;
  Buffer<uint8_t> stand_ins_;
  Buffer<Block> blocks_;
  Buffer<Tier> tiers_;
  Buffer<Segment> segments_;
  Buffer<WindowPlaces> windows_;
  Buffer<uint32_t> open_counts_, open_blocks_, open_block_count_, dirty_flags_, dirty_;
  Buffer<uint32_t> due_, signals_;
  Buffer<FrameCounters> counters_;
  Buffer<uint32_t> nodes_;
  Buffer<MeanBounds> bounds_;
};

}  // namespace voyager::cuda
