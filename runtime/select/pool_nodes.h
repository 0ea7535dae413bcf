#pragma once
// Which subtree owns a node of a pool, and what the node hangs from. A node's address is a slot and
// a place in it. A code of one or two bytes says which of the chunk's subtrees owns it, and all
// else follows from that subtree.
#include <cstddef>
#include <cstdint>

#include "runtime/select/search_tree.h"

namespace voyager {

// No chunk has more subtrees than nodes.
VOYAGER_HD constexpr size_t owner_code_bytes(uint32_t slot_nodes) {
  return slot_nodes <= 256 ? 1 : 2;
}

struct PoolNodes {
  const void* owners;             // by address: codes of owner_code_bytes(), the subtree's index
  uint32_t stride;                // bytes from one code to the next
  const uint32_t* first_subtree;  // of the chunk in each slot
  uint32_t slot_nodes;            // places of a slot

  // The subtree that owns a node.
  VOYAGER_HD uint32_t owner(uint32_t node) const {
    const uint8_t* const code = static_cast<const uint8_t*>(owners) + size_t{node} * stride;
    return first_subtree[node / slot_nodes] +
           (owner_code_bytes(slot_nodes) == 1 ? *code : *reinterpret_cast<const uint16_t*>(code));
  }
};

// Of nodes whose subtrees are linked.
struct PoolParents {
  PoolNodes nodes;
  const SearchSubtree* subtrees;  // by place
  // By place: the parent of the subtree's roots. Where it repeats a node: the node itself.
  const uint32_t* outside;
  SubtreePlaces places;

  VOYAGER_HD uint32_t operator()(uint32_t node) const {
    const uint32_t place = places(nodes.owner(node));
    const SearchSubtree s = subtrees[place];
    const uint32_t slot = s.slot_of(node);
    if (s.level_of(slot) == 0) return outside[place];
    const uint32_t parent = nth_bit(s.interior, s.parent_rank(slot));
    return parent < s.first_owned_slot() ? outside[place] : s.node(parent);
  }
};

}  // namespace voyager
