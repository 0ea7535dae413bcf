#pragma once
// How much room there is in a scene's budget, which holds for the pool, what links its chunks, and
// what the views that read it keep.
#include <algorithm>

#include "runtime/stream/chunk_pool.h"
#include "runtime/stream/record_room.h"

namespace voyager {

// What an instance's list of cut nodes has room for.
struct ListRoom {
  // Nodes: for each slot, and beside them. Without slot: any cut, and nothing is counted.
  uint64_t slot = 0, fixed = 0;
  uint64_t most = UINT64_MAX;  // nodes that any cut of the scene has at most
  // Bytes: for eight of them; for what else a list of eight may have; and the most that this comes
  // to.
  uint64_t eight_nodes = 0, ends_of_eight = 0, most_ends = 0;

  uint64_t nodes(PoolRoom room) const {
    return slot == 0 ? UINT64_MAX : std::min(most, room.slots * slot + fixed);
  }
  uint64_t bytes(PoolRoom room) const {
    if (slot == 0) return 0;
    const uint64_t eights = nodes(room) / 8 + 1;
    return eights * eight_nodes + std::min(eights * ends_of_eight, most_ends);
  }
};

struct RoomBytes {
  PoolBytes pool;  // with what links its chunks, where that lies in the same memory
  PoolBytes view;  // what each instance in a view keeps beside its list
  ListRoom list;

  // A scene without views has room for one.
  uint64_t of(PoolRoom room, size_t views = 1) const {
    return pool.of(room) + std::max<size_t>(views, 1) * (view.of(room) + list.bytes(room));
  }
};

// The most that fits beside so many views; budget 0: no limit. Throws Error(over_budget) where
// there is no room for the top of the tree; the message names what that takes.
PoolRoom fit_room(const SceneFile& file, const RecordRoom& records, const RoomBytes& bytes,
                  uint64_t budget, size_t views);

}  // namespace voyager
