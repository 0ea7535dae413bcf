#pragma once
// What a subtree's part of the search is made from: of a tree in memory, and of a chunk by
// itself. record(slot) gives the NodeRecord of each of its nodes.
#include "runtime/select/search_tree.h"

namespace voyager {

inline uint32_t slot_bits(uint32_t first, uint32_t count) {
  return ((1u << count) - 1u) << first;
}

inline uint32_t slot_levels(const Subtree& subtree) {
  return slot_levels(subtree.first_child_slot(), subtree.first_grandchild_slot(),
                     subtree.node_count(), subtree.first_owned_slot());
}

// As SearchSubtree::families.
template <class Record>
uint32_t family_slots(const Subtree& subtree, const Record& record) {
  uint32_t families = 0;
  each_family(
      subtree, [&](uint32_t slot) { return record(slot).child_count; },
      [&](uint32_t, uint32_t first, uint32_t count) { families |= slot_bits(first, count != 0); });
  return families;
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
void fill_search_records(const Subtree& subtree, const Record& record, SearchRecord* out) {
  uint32_t children[kSubtreeNodes] = {};
  each_family(
      subtree, [&](uint32_t slot) { return record(slot).child_count; },
      [&](uint32_t parent, uint32_t first, uint32_t count) {
        children[parent] = slot_bits(first, count);
      });
  for (uint32_t slot = 0; slot < subtree.node_count(); ++slot) {
    const NodeRecord& from = record(slot);
    if (from.child_count != 0)
      *out++ = {children[slot], encode_bounds({from.box_min, from.extent, from.box_max})};
  }
}

}  // namespace voyager
