#pragma once
// What a node of a pool hangs from. Its parent is usually in the same slot: then the code is the
// parent's place there. Otherwise the code is slot_nodes and the index of the node's subtree in the
// chunk, and `outside` has that subtree's one parent elsewhere: of its roots, or, where it repeats
// a node, of that node's children.
#include <cstddef>
#include <cstdint>

#include "runtime/math/host_device.h"
#include "runtime/math/subtree_places.h"

namespace voyager {

// Of a slot with so many places. No chunk has more subtrees than nodes.
VOYAGER_HD constexpr uint32_t outside_code(uint32_t slot_nodes, uint32_t subtree) {
  return slot_nodes + subtree;
}
VOYAGER_HD constexpr size_t parent_code_bytes(uint32_t slot_nodes) {
  return 2 * slot_nodes <= 256 ? 1 : 2;
}

struct PoolParents {
  const void* codes;              // by address: of parent_code_bytes()
  const uint32_t* first_subtree;  // of the chunk in each slot
  const uint32_t* outside;        // by the subtree's place
  SubtreePlaces places;
  uint32_t slot_nodes;

  VOYAGER_HD uint32_t operator()(uint32_t node) const {
    const uint32_t slot = node / slot_nodes;
    const uint32_t code = parent_code_bytes(slot_nodes) == 1
                              ? static_cast<const uint8_t*>(codes)[node]
                              : static_cast<const uint16_t*>(codes)[node];
    return code < slot_nodes ? slot * slot_nodes + code
                             : outside[places(first_subtree[slot] + (code - slot_nodes))];
  }
};

}  // namespace voyager
