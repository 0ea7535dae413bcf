#pragma once
// Where the chunks of a scene lie that are resident: on the host, or on a device.
#include <span>

#include "runtime/stream/link_patch.h"
#include "runtime/stream/staged_chunk.h"

namespace voyager {

// Places in a slot, where a node's address is slot * that + its place, and what a chunk has of
// search records at most.
struct SlotShape {
  uint32_t nodes, records;
};

// What a pool has room for: chunks, blocks of search records, pages of subtrees where its tables do
// not have all of the file's, and large families (large_families.h).
struct PoolRoom {
  uint32_t slots, blocks, pages = 0, families = 0;
};

// What goes with a pool's room: for each slot, each block, beside them, for each page, which is 0
// where its tables have all subtrees, and for each large family.
struct PoolBytes {
  uint64_t slot, block, fixed, page = 0, family = 0;

  uint64_t of(PoolRoom room) const {
    return fixed + room.slots * slot + room.blocks * block + room.pages * page +
           room.families * family;
  }
  PoolBytes operator+(const PoolBytes& other) const {
    return {slot + other.slot, block + other.block, fixed + other.fixed, page + other.page,
            family + other.family};
  }
};

// What an instance in a view keeps of a pool from frame to frame.
class PoolReaderState {
 public:
  virtual ~PoolReaderState() = default;
  // Frees what grows with the pool's room: that is about to change. No frame is being drawn, but
  // what was drawn last may be asked for meanwhile. The next frame takes what it needs.
  virtual void drop() noexcept = 0;
};

class ChunkPool {
 public:
  virtual ~ChunkPool() = default;
  // Slots that no frame reads, and blocks that none reads, which each of the chunks names; several
  // threads at once, each slots of its own. Throws Error where the pool itself is at fault; then
  // all of them count as not filled.
  virtual void fill(std::span<const StagedChunk* const> chunks) = 0;
  // Of a search record of a chunk that was filled, as searches read it: its address, its chunk's
  // slot, and which of StagedChunk::checked it is.
  struct CheckedRecord {
    uint32_t record, slot, checked;
  };
  virtual const BoundsCode& bounds(const CheckedRecord& of) const = 0;
  // Between two frames: what was filled before and is linked now is there for the next one.
  virtual void apply(const LinkPatch& patch) = 0;
  // Until frames in flight that read the pool have ended, which may wait for the host; none begins
  // meanwhile. Throws Error(timeout) where that takes too long.
  virtual void await_frames() {}
  // Other room instead; what they held is lost, and nothing is linked. No frame
  // reads the pool and no slot is being filled. Throws Error(over_budget) or std::bad_alloc,
  // and may then have any room up to what it had; where it has as much already, a pool may keep
  // its memory, and then throws nothing.
  virtual void resize(PoolRoom room) = 0;
};

}  // namespace voyager
