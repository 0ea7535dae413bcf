#pragma once
// What a cell, or the top, has of one tier, as the file will have it: whole chunks
// encoded, and the pieces of those that it shares with its neighbours.
#include "runtime/bake/piece.h"
#include "runtime/bake/plan.h"
#include "runtime/base/workers.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// The nodes of a segment.
struct SegmentNodes {
  const BakedScene& baked;
  uint32_t levels;                       // of the tier
  uint32_t first_root, end_root;         // in baked
  const NodeRecord* above;               // parent of node 0 of baked; none for the tree's root
  const std::vector<uint32_t>* sources;  // of baked's leaves in the input; none without leaves
};

struct EncodedSegment {
  Piece head;  // of a chunk that was begun before
  // Chunks that begin and end here; their entries lack only the place in the file.
  std::vector<ChunkEntry> entries;
  Piece tail;  // of the chunk that is begun last, which may go on
  double position_error = 0;
  float largest_sh = 0;
  bool leaves_have_extent = false;
};

// `write` is called with the bytes of each whole chunk, in order.
template <class Write>
EncodedSegment encode_segment(const Segment& segment, const SegmentNodes& nodes,
                              uint32_t chunk_bytes, const ChunkContext& context, Workers& workers,
                              const Write& write);

// The subtrees of a segment and where its chunks divide them.
struct SegmentRuns {
  std::pmr::vector<Subtree> subtrees;
  std::vector<SubtreePlace> places;  // before each run
  std::vector<uint32_t> begin;       // of each run, and the end; the first is the head's
};
SegmentRuns divide(const Segment& segment, const SegmentNodes& nodes, uint32_t chunk_bytes);

// Run `index` as a piece.
Piece make_piece(const Segment& segment, const SegmentNodes& nodes, const SegmentRuns& runs,
                 size_t index);

template <class Write>
EncodedSegment encode_segment(const Segment& segment, const SegmentNodes& nodes,
                              uint32_t chunk_bytes, const ChunkContext& context, Workers& workers,
                              const Write& write) {
  constexpr size_t kBatch = 256, kGrain = 8;  // chunks
  const SegmentRuns runs = divide(segment, nodes, chunk_bytes);
  EncodedSegment out;
  out.head = make_piece(segment, nodes, runs, 0);
  const size_t last = runs.places.size() - 1;
  if (last == 0) return out;
  out.tail = make_piece(segment, nodes, runs, last);
  for (size_t begin = 1; begin < last; begin += kBatch) {
    std::vector<EncodedChunk> batch(std::min(kBatch, last - begin));
    std::vector<ChunkEntry> entries(batch.size());
    workers.for_blocks(batch.size(), kGrain, [&](size_t first, size_t end) {
      for (size_t i = first; i < end; ++i) {
        const Piece piece = make_piece(segment, nodes, runs, begin + i);
        batch[i] = encode_chunk(piece.chunk, context);
        entries[i] = entry_of(piece, batch[i]);
      }
    });
    for (size_t i = 0; i < batch.size(); ++i) {
      write(batch[i].bytes);
      out.entries.push_back(entries[i]);
      out.position_error = std::max(out.position_error, batch[i].position_error);
      out.largest_sh = std::max(out.largest_sh, batch[i].largest_sh);
      out.leaves_have_extent |= batch[i].leaves_have_extent;
    }
  }
  return out;
}

}  // namespace voyager
