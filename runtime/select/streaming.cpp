// Chunk by chunk from the top. A tier's open subtrees are known before it is read:
// the tier above has marked them.
#include <algorithm>

#include "runtime/select/partitioned.h"
#include "runtime/select/partitioned_blocks.h"
#include "runtime/select/signal.h"

namespace voyager {

void PartitionedSearch::stream(Workers& workers) {
  stats_.ran = Search::streaming;
  start_over(workers);
  if (blocks_.empty()) return;
  uint32_t first = 0, last = tree_.tier_begin[1];
  Tally root;
  for (uint32_t s = first; s < last; ++s) open(s, root);
  count(root);
  while (first < last) {
    total_.first_opened = kNoNode;
    total_.last_opened = 0;
    stream_tier(first, last, workers);
    first = total_.first_opened;
    last = total_.last_opened + 1;
  }
}

// Closes everything; last_cut_slots_ stays, to be compared with.
void PartitionedSearch::start_over(Workers& workers) {
  if (!continues_) return clear(workers);
  workers.for_blocks(blocks_.size(), kBlocksTask, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b) {
      Block& block = blocks_[b];
      if (block.open == 0) continue;
      touched_[b] = 1;
      each_place(places_, block.first, block.last, [&](uint32_t s, uint32_t place) {
        if (refined_[place] != 0) close(s);
      });
    }
  });
}

void PartitionedSearch::clear(Workers& workers) {
  std::fill(touched_.begin(), touched_.end(), uint8_t{1});
  workers.for_blocks(watch_.size(), kBlockSubtrees * kBlocksTask, [&](size_t begin, size_t end) {
    const auto fill = [&](auto& array, const auto& value) {
      std::fill(array.begin() + static_cast<std::ptrdiff_t>(begin),
                array.begin() + static_cast<std::ptrdiff_t>(end), value);
    };
    fill(watch_, kNever);
    fill(refined_, 0u);
    fill(cut_slots_, 0u);
    fill(last_cut_slots_, 0u);
    if (!stand_ins_.empty()) fill(stand_ins_, uint8_t{0});
  });
}

void PartitionedSearch::open(uint32_t subtree, Tally& tally) {
  tally.first_opened = std::min(tally.first_opened, subtree);
  tally.last_opened = std::max(tally.last_opened, subtree);
  const uint32_t place = places_(subtree);
  if (tree_.subtrees[place].missing())
    tally.needed_missing = std::min(tally.needed_missing, subtree);
  else
    refined_[place] = kOpen;
}

// Subtrees [first, last) of one tier.
void PartitionedSearch::stream_tier(uint32_t first, uint32_t last, Workers& workers) {
  const uint32_t first_chunk = tree_.chunk_with(first, 0);
  const uint32_t chunks = tree_.chunk_with(last - 1, first_chunk) + 1 - first_chunk;
  workers.for_blocks(chunks, kChunksTask, [&](size_t begin, size_t end) {
    Tally tally;
    for (size_t i = begin; i < end; ++i)
      stream_chunk(first_chunk + static_cast<uint32_t>(i), first, last, tally);
    count(tally);
  });
}

void PartitionedSearch::stream_chunk(uint32_t chunk, uint32_t first, uint32_t last, Tally& tally) {
  const SearchChunk c = tree_.chunk(chunk);
  tally.bytes += sizeof c;
  ++tally.tested;
  if (!(decode_bounds(c.hull).screen_size(sight_.centre) >= sight_.target_size)) return;
  first = std::max(first, c.first_subtree);
  last = std::min(last, c.last_subtree);
  tally.bytes += (last - first) * sizeof refined_[0];
  bool read = false;
  for (uint32_t s = first; s < last; ++s) {
    if (refined_[places_(s)] != kOpen) continue;
    read = true;
    const uint32_t refined = look(s, tally);
    signal_below(
        tree_, s, refined, refined,
        [&](uint32_t from, uint32_t to) {
          for (uint32_t below = from; below < to; ++below) open(below, tally);
        },
        [](uint32_t, uint32_t) {});
  }
  if (!read) return;
  tally.chunks += mark_read(chunk);
  for (size_t b = block_of(first); b <= block_of(last - 1); ++b) touch(b);
}

}  // namespace voyager
