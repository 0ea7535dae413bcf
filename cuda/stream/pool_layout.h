#pragma once
// Where a pool's arrays lie in its one allocation: as DeviceScene and DeviceTree have them,
// but by address, slot by slot and block by block. A chunk on its way has the same arrays.
#include <array>
#include <cstddef>

#include "cuda/scene/gaussian_view.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

enum PoolArray : uint32_t {
  // What a chunk brings: by node, by block of records, by slot.
  kHulls,
  kShapes,
  kCoefficients,
  kLeaves,
  kOpacities,
  kOwners,  // none where shapes have them
  kChildCounts,
  kNodeCodes,
  kRecords,        // blocks
  kNextBlocks,     // one a block; of a chunk on its way, its blocks
  kStepSizes,      // one a slot
  kMeanGrids,      // the same
  kFirstSubtrees,  // the same
  kFilledArrays,
  // By page of subtrees (runtime/math/subtree_places.h).
  kSubtrees = kFilledArrays,
  kOutside,  // one a subtree; of one that is in no cut it may be anything
  // One a slot, of the chunk that has arrived there.
  kChunks,
  // Of the whole tree.
  kPages,  // one a page
  // Of a compact scene.
  kLargeFamilies,
  kLargeFamilyCount,
  kPoolArrays
};

// What there is of an array that a chunk brings: as many elements as it has of these.
enum PoolCount : uint32_t { kNodes, kRecordsOwned, kBlocks, kOnce, kPoolCounts };
constexpr PoolCount counted_by(uint32_t array) {
  if (array == kRecords) return kRecordsOwned;
  if (array == kNextBlocks) return kBlocks;
  return array >= kStepSizes && array <= kFirstSubtrees ? kOnce : kNodes;
}

// Bytes that are copied at once of elements of such a size.
constexpr uint32_t word_bytes(uint32_t unit) {
  return unit % 16 == 0 ? 16 : unit % 4 == 0 ? 4 : 1;
}

// Of the coefficients of a streamed scene, as a resident one decides it.
ShForm sh_form(const Scene& scene);

// Whether owner codes (runtime/select/pool_nodes.h) are in ShapeRest::children.
bool owners_in_shapes(const Scene& scene, SlotShape shape);

class PoolLayout {
 public:
  PoolLayout(const Scene& scene, SlotShape shape, PoolRoom room);
  void set_room(PoolRoom room);

  // Bytes of an element.
  size_t unit(PoolArray array) const { return unit_[array]; }
  // Bytes that a slot takes of it; 0 of records, and of what is by page or the whole tree's.
  size_t slot_bytes(PoolArray array) const { return slot_bytes_[array]; }
  // What it takes beside slots, blocks and pages.
  size_t fixed_bytes(PoolArray array) const { return fixed_bytes_[array]; }
  // From the allocation's start; multiples of 256.
  size_t begin(PoolArray array) const { return begin_[array]; }
  size_t bytes() const { return begin_[kPoolArrays]; }
  // Of the arrays that a chunk brings, which come first.
  size_t filled_bytes() const { return begin_[kFilledArrays]; }
  // Together at least bytes(), whatever the room.
  PoolBytes pool_bytes() const;

 private:
  std::array<size_t, kPoolArrays> unit_, slot_bytes_, block_bytes_, page_bytes_, fixed_bytes_;
  size_t family_bytes_;  // of each large family
  std::array<size_t, kPoolArrays + 1> begin_;
};

}  // namespace voyager::cuda
