#pragma once
// A chunk that was read, before it has a place: what its slot will hold, in numbers of its
// own. Records are counted from the chunk's first; nodes by their places in the slot, which are
// in the order of their ids.
#include <string>
#include <utility>
#include <vector>

#include "runtime/format/chunk.h"
#include "runtime/stream/link_table.h"
#include "runtime/stream/slot_ids.h"

namespace voyager {

struct StagedChunk {
  uint32_t chunk = 0;
  LinkTable links;  // what stays
  Chunk content;
  std::vector<SearchRecord> records;  // those of the lowest level are blocked
  std::vector<NodeRecord> roots;      // of each subtree in turn
  std::vector<LargeFamily> large;     // parents by place
  // Numbers of the records that chunks which come later are checked against: those of the nodes
  // that lead to subtrees below, in their order; of the last subtree's first root and first child,
  // which the next chunk may repeat; and of the first subtree's, where those repeat others. Of a
  // leaf: any.
  std::vector<uint32_t> checked;
  // Of each owned node, in the order of the content: its place in a slot, and the index of its
  // subtree in the chunk.
  std::vector<uint32_t> place, owner;
  SlotIds ids;
  std::vector<uint32_t> blocks;  // that its records lie in, once it has a slot

  uint32_t record_blocks() const {
    return voyager::record_blocks(static_cast<uint32_t>(records.size()));
  }
  void put(uint32_t slot, std::vector<uint32_t> into) {
    links.slot = slot;
    links.first_block = into.empty() ? 0 : into.front();
    blocks = std::move(into);
  }
  // The address of a record.
  uint32_t record(uint32_t number) const {
    return blocks[number / kRecordBlock] * kRecordBlock + number % kRecordBlock;
  }
  // Its slot has been filled: what linking does not need.
  void drop_content();
};

// tiers: the file's. Throws Error(damaged_chunk) naming `file`, the chunk and the node where
// a box or an extent is larger than its parent's, or a repeated record is not its owner's,
// as far as the chunk by itself can show it.
StagedChunk stage_chunk(Chunk&& chunk, uint32_t index, const Tiers& tiers, const std::string& file);

// Error(damaged_chunk) naming file, chunk and node.
[[noreturn]] void refuse_nesting(uint32_t chunk, uint32_t node, const std::string& file);
[[noreturn]] void refuse_roots(uint32_t chunk, uint32_t node, const std::string& file);
[[noreturn]] void refuse_repeat(uint32_t chunk, uint32_t node, const std::string& file);
[[noreturn]] void refuse_gap(uint32_t chunk, const std::string& file);
// Naming file and chunk.
[[noreturn]] void refuse_records(const StagedChunk& staged, const std::string& file);

}  // namespace voyager
