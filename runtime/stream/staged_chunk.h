#pragma once
// A chunk that was read, before it has a place: what its slot will hold, in numbers of its
// own. Records are counted from the chunk's first; nodes by their places in the slot, which are
// in the order of their ids.
#include <array>
#include <string>

#include "runtime/format/chunk.h"
#include "runtime/lod/nesting.h"
#include "runtime/lod/subtree_cursor.h"
#include "runtime/math/large_families.h"
#include "runtime/select/search_tree.h"
#include "runtime/stream/slot_ids.h"

namespace voyager {

struct StagedSubtree {
  Subtree ids;  // nodes as the file numbers them
  // Places of the first that it owns of each level: roots, children, grandchildren.
  std::array<uint32_t, 3> first_place;
  uint32_t first_record;  // as in SearchSubtree
  uint32_t first_below;   // in LinkTable::below
  uint32_t interior, families;
  bool linked = false;  // a refined node may lead to it (Linker)
};

// An interior node of its tier's lowest level: subtrees of other chunks hang from it.
struct NodeBelow {
  uint32_t node, record;
  uint32_t first_child, child_count;  // as the file numbers them
  uint32_t subtree;                   // in LinkTable::subtrees
  NodeRecord box;
  bool linked = false;  // the subtrees below are there, and so is all above
};

// What stays on the host of a chunk that is resident.
struct LinkTable {
  uint32_t chunk = 0, slot = 0;
  std::vector<uint32_t> blocks;  // that its records lie in
  uint32_t first_subtree = 0;
  std::vector<StagedSubtree> subtrees;
  std::vector<NodeBelow> below;
  std::vector<LargeFamily> large;  // parents by place

  // The address of a record.
  uint32_t record(uint32_t number) const {
    return blocks[number / kRecordBlock] * kRecordBlock + number % kRecordBlock;
  }
  // The first root and child of the first and of the last subtree: neighbours may repeat them.
  NodeRecord first_root{}, first_child{}, last_root{}, last_child{};
};

struct StagedChunk {
  LinkTable links;
  Chunk content;
  std::vector<SearchRecord> records;  // those of the lowest level are blocked
  std::vector<NodeRecord> roots;      // of each subtree in turn
  // Of each owned node, in the order of the content: its place, and its parent's, or kOutside with
  // the index of its subtree in the chunk, where that does not own the parent (parent_code.h).
  std::vector<uint32_t> place, parent;
  static constexpr uint32_t kOutside = 0x80000000u;
  SlotIds ids;

  uint32_t record_blocks() const {
    return voyager::record_blocks(static_cast<uint32_t>(records.size()));
  }
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
