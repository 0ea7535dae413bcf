#pragma once
// The fully streaming search, as a warp runs it (METHOD §9).
#include "cuda/device/warp.cuh"
#include "cuda/search/cut_lanes.cuh"

namespace voyager::cuda {

// Chunks that a warp takes at a time, one a lane: few, so that no warp is left with
// many at the end.
inline constexpr uint32_t kTicketChunks = 8;

// The subtrees of a ticket's chunks, those of the chunks that are left out taken out.
struct Ticket {
  uint32_t first = 0;   // subtree of this lane's chunk
  uint32_t before = 0;  // subtrees in the chunks of lower lanes
  uint32_t total = 0;   // of all lanes
};

__device__ inline Ticket make_ticket(uint32_t first, uint32_t count) {
  Ticket ticket;
  ticket.first = first;
  const uint32_t sum = warp_scan<kTicketChunks>(count);
  ticket.before = sum - count;
  ticket.total = __shfl_sync(kAllLanes, sum, kTicketChunks - 1);
  return ticket;
}

// The k-th subtree; k < total.
__device__ inline uint32_t subtree_of(const Ticket& ticket, uint32_t k) {
  uint32_t subtree = 0;
#pragma unroll
  for (unsigned lane = 0; lane < kTicketChunks; ++lane) {
    const uint32_t before = __shfl_sync(kAllLanes, ticket.before, lane);
    const uint32_t first = __shfl_sync(kAllLanes, ticket.first, lane);
    if (k >= before) subtree = first + (k - before);
  }
  return subtree;
}

// reached: of chunks that may hold part of the cut. In others what was open is closed.
__device__ inline void read_subtrees(const TreeView& tree, const StateView& state,
                                     const Sight& sight, uint32_t reference, const Ticket& ticket,
                                     bool reached, Tally& tally) {
  for (uint32_t base = 0; base < ticket.total; base += 32) {
    const bool there = base + lane_in_warp() < ticket.total;
    const uint32_t subtree = subtree_of(ticket, there ? base + lane_in_warp() : base);
    SearchSubtree s = kUnlinkedSubtree;
    Known known;
    bool open = false;
    if (there) {
      known = load_known(state, subtree);
      s = load_own_subtree(tree, known.place);
      open = reached && is_own_reached(tree, s, sight, tally);
    }
    const Visit v = visit_lanes(tree, s, open, sight, tally);
    Change change;
    if (there)
      change = open ? settle_own(state, subtree, known, v, reference, tally)
                    : close_own(state, known, tally);
    count_changes(state, subtree, s.levels, change, tally);
  }
}

__device__ inline bool has_open(const StateView& state, uint32_t first, uint32_t last) {
  bool open = false;
  for (uint32_t b = block_of(state, first); b <= block_of(state, last - 1); ++b)
    open |= state.open_counts[b] != 0;
  return open;
}

// Dynamic dispatch: a warp takes a ticket of chunks, tests the hull of each on a lane,
// and reads those that may hold part of the cut. No chunk waits for another.
__device__ inline void stream_chunks(const TreeView& tree, const StateView& state,
                                     const Sight& sight, uint32_t reference, Tally& tally) {
  for (;;) {
    uint32_t taken = 0;
    if (lane_in_warp() == 0) taken = atomicAdd(&state.counting->next_chunks, kTicketChunks);
    taken = __shfl_sync(kAllLanes, taken, 0);
    if (taken >= tree.chunk_count) return;
    const uint32_t chunk = taken + lane_in_warp();
    uint32_t first = 0, count = 0;
    bool reached = false, stale = false;
    if (lane_in_warp() < kTicketChunks && chunk < tree.chunk_count) {
      const SearchChunk c = tree.chunks[chunk];
      first = c.first_subtree;
      count = c.last_subtree - first;
      reached = count != 0 && judge(decode_bounds(c.hull), sight).refined;
      stale = count != 0 && !reached && has_open(state, first, c.last_subtree);
      tally.hulls += count != 0;
      tally.chunks += reached;
    }
    if (__any_sync(kAllLanes, reached))
      read_subtrees(tree, state, sight, reference, make_ticket(first, reached ? count : 0), true,
                    tally);
    if (__any_sync(kAllLanes, stale))
      read_subtrees(tree, state, sight, reference, make_ticket(first, stale ? count : 0), false,
                    tally);
  }
}

}  // namespace voyager::cuda
