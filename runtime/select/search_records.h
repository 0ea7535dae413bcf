#pragma once
// What a subtree's part of the search is made from: of a tree in memory, and of a chunk by
// itself. record(slot) gives the NodeRecord of each of its nodes.
#include "runtime/select/search_tree.h"

namespace voyager {

inline uint32_t slot_bits(uint32_t first, uint32_t count) {
  return ((1u << count) - 1u) << first;
}

// levels: of the subtree's tier.
inline bool is_lowest(uint32_t slot, uint32_t child_count, uint32_t levels) {
  const uint32_t level = slot == 0 ? 0 : slot <= child_count ? 1 : 2;
  return level + 1 == levels;
}

inline uint32_t owned_slots(const Subtree& subtree) {
  uint32_t owned = slot_bits(0, subtree.node_count());
  if (subtree.repeats_root) owned &= ~1u;
  if (subtree.repeats_child) owned &= ~2u;
  return owned;
}

template <class Record>
uint32_t interior_slots(const Subtree& subtree, const Record& record) {
  uint32_t interior = 0;
  for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
    if (record(slot).child_count != 0) interior |= 1u << slot;
  return interior;
}

// One for each interior slot, in their order.
template <class Record>
void fill_search_records(const Subtree& subtree, uint32_t levels, const Record& record,
                         SearchRecord* out) {
  const uint32_t nodes = subtree.node_count();
  // An only child may be one of several runs.
  const bool child_in_runs = subtree.child_count == 1;
  uint32_t grandchild = 1u + subtree.child_count;
  for (uint32_t slot = 0; slot < nodes; ++slot) {
    const NodeRecord& from = record(slot);
    if (from.child_count == 0) continue;
    uint32_t children = 0;
    if (slot == 0 && levels > 1) children = slot_bits(1, subtree.child_count);
    if (slot > 0 && slot <= subtree.child_count && levels > 2) {
      const uint32_t count = child_in_runs ? nodes - 2 : from.child_count;
      children = slot_bits(grandchild, count);
      grandchild += count;
    }
    *out++ = {from.box_min, from.extent, from.box_max, children};
  }
}

}  // namespace voyager
