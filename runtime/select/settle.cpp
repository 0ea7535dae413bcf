// What a run has changed, and the list of the cut.

#include "runtime/select/partitioned.h"
#include "runtime/select/partitioned_blocks.h"
#include "runtime/select/set_bits.h"

namespace voyager {

// Counts again a block where something was visited or closed.
void PartitionedSearch::settle(size_t index, Tally& tally) {
  Block& block = blocks_[index];
  touched_[index] = 0;
  block.open = 0;
  block.size = {};
  block.stand_ins = 0;
  each_place(places_, block.first, block.last, [&](uint32_t, uint32_t place) {
    const uint32_t now = cut_slots_[place], before = last_cut_slots_[place];
    block.open += refined_[place] != 0;
    if (!stand_ins_.empty()) block.stand_ins += stand_ins_[place];
    if (now != before) {
      tally.entered += count_bits(now & ~before);
      tally.left += count_bits(before & ~now);
      last_cut_slots_[place] = now;
    }
    if (now == 0) return;
    for (uint32_t level = 0; level < 3; ++level)
      block.size[level] += count_bits(now & tree_.subtrees[place].level_slots(level));
  });
  tally.bytes += (block.last - block.first) * 3 * sizeof(uint32_t);
}

void PartitionedSearch::list_cut(Workers& workers) {
  uint32_t at = 0;
  for (size_t first = 0, last = 0; first < blocks_.size(); first = last) {
    while (last < blocks_.size() && blocks_[last].tier == blocks_[first].tier) ++last;
    for (uint32_t level = 0; level < 3; ++level)
      for (size_t b = first; b < last; ++b) {
        blocks_[b].at[level] = at;
        at += blocks_[b].size[level];
      }
  }
  cut_size_ = at;
  if (!lists_cut_) return;
  cut_.resize(at);
  workers.for_blocks(blocks_.size(), kBlocksTask, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b) list_block(blocks_[b]);
  });
}

void PartitionedSearch::list_block(const Block& block) {
  for (uint32_t level = 0; level < 3; ++level) {
    if (block.size[level] == 0) continue;
    uint32_t* out = cut_.data() + block.at[level];
    const uint32_t* const end = out + block.size[level];
    each_place(places_, block.first, block.last, [&](uint32_t, uint32_t place) {
      const uint32_t slots = cut_slots_[place];
      if (slots == 0) return;
      const SearchSubtree& subtree = tree_.subtrees[place];
      const uint32_t first_slot = subtree.first_slot(level), node = subtree.first_node(level);
      out = put_set_bits<8>((slots & subtree.level_slots(level)) >> first_slot, out, end,
                            [node](uint32_t slot) { return node + slot; });
    });
  }
}

}  // namespace voyager
