#pragma once
// What a node of a pool hangs from. Its address is a slot's, and a place in it; a code of a byte or
// two says which of the chunk's subtrees owns it, and that subtree says the rest.
#include <cstddef>
#include <cstdint>

#include "runtime/select/search_tree.h"

namespace voyager {

// No chunk has more subtrees than nodes.
VOYAGER_HD constexpr size_t owner_code_bytes(uint32_t slot_nodes) {
  return slot_nodes <= 256 ? 1 : 2;
}

struct PoolNodes {
  // By address: the subtree's index in the chunk, in as many bytes as owner_code_bytes() says,
  // each so many after the last.
  const void* owners;
  uint32_t stride;
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
  // By place: what the subtree's roots hang from; where it repeats a node, what hangs from that
  // hangs from this.
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
